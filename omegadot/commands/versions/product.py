"""An engine as a product with releases: its adapter, its package, and what it needs with it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from omegadot.adapters.registry import BUILT_IN
from omegadot.harness.usage import UsageError, nearest

ALWAYS = ("numpy", "scipy")  # what a worker needs besides its engine


@dataclass(frozen=True)
class Product:
    """engine: its name here.  target: its adapter.  package: its name where it is installed from.

    extras: what must be installed with some releases.
    """

    engine: str
    target: str
    package: str
    extras: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def requirements(self, version: str) -> list[str]:
        """What to install for a release."""
        return [f"{self.package}=={version}", *ALWAYS, *self.extras.get(version, ())]


# These releases accept any version of the two libraries, and are linked against older ones.
_OLDER_LIBRARIES = ("cmeel-urdfdom<5", "cmeel-tinyxml2<11")
_PINOCCHIO_EXTRAS = dict.fromkeys(("3.4.0", "3.7.0", "3.8.0", "3.9.0"), _OLDER_LIBRARIES)
PRODUCTS = (
    Product("mujoco", BUILT_IN["mujoco"], "mujoco"),
    Product("dart", BUILT_IN["dart"], "dartpy"),
    Product("pinocchio", BUILT_IN["pinocchio"], "pin", _PINOCCHIO_EXTRAS),
)


def product_of(argument: str, target: str = "", package: str = "") -> Product:
    """The product that an engine's or a package's name stands for; with a target, one's own.

    Raises UsageError.
    """
    if target:
        return Product(argument, target, package or argument)
    known = {name: product for product in PRODUCTS for name in (product.engine, product.package)}
    if argument not in known:
        raise UsageError(
            f"{argument}: no such engine with releases; {nearest(argument, known)}, "
            "or name an adapter of your own with --adapter FILE.py:Class."
        )
    return known[argument]
