"""Version numbers of releases: their order, and ranges of them."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from packaging.version import Version

from omegadot.adapters.registry import BUILT_IN
from omegadot.harness.usage import UsageError, nearest


def version_of(text: str) -> Version | None:
    """What releases are ordered by; None of a text that is no version (PEP 440)."""
    try:
        return Version(text)
    except ValueError:  # InvalidVersion, or one of thousands of digits
        return None


def rising(versions: Iterable[str]) -> list[str]:
    """Versions in rising order, each once; what is no version is left out."""
    known = {version: text for text in versions if (version := version_of(text)) is not None}
    return [known[version] for version in sorted(known)]


@dataclass(frozen=True)
class Span:
    """Both ends belong to it; an end that is empty is open."""

    low: str
    high: str

    def of(self, versions: Iterable[str]) -> list[str]:
        """Those of the versions that lie in it, without pre-releases, rising."""
        low, high = version_of(self.low), version_of(self.high)
        return [
            text
            for text in rising(versions)
            if not (version := Version(text)).is_prerelease
            and (low is None or version >= low)
            and (high is None or version <= high)
        ]


FEWEST = 2


def requested_releases(
    arguments: Sequence[str],
    releases: Callable[[Span], Sequence[str]],
    cached: Sequence[str] | None = None,
) -> tuple[list[str], dict[str, str]]:
    """The releases of ``VERSION``, ``LOW..HIGH`` and ``VERSION=PYTHON`` arguments, rising.

    With them the interpreters that some of the releases have already.
    releases: the published ones, looked up where a range needs them.  cached: offline, those of the
    cache; the ends of a range are then versions too, so that it is seen which of them is not there.
    Raises UsageError.
    """
    versions: list[str] = []
    pythons: dict[str, str] = {}
    for argument in arguments:
        version, own, path = argument.partition("=")
        low, dots, high = version.partition("..")
        for number in filter(None, (low, high) if dots else (version,)):
            if version_of(number) is None:
                raise UsageError(
                    f"{argument}: {number!r} is no version; write 1.2.3 or 1.2.0..1.4.0."
                )
        if own:
            if dots:
                raise UsageError(
                    f"{argument}: a range has no single interpreter; give VERSION=PYTHON."
                )
            if shutil.which(path) is None:
                named = path or "nothing"
                raise UsageError(f"{argument}: {named} is no program; give a Python interpreter.")
            versions.append(version)
            pythons[version] = path
        elif dots and not (low and high):  # all releases of an engine are gigabytes
            raise UsageError(f"{argument}: a range has two ends; write 1.2.0..1.4.0.")
        elif dots:
            span = Span(low, high)
            versions += _within(argument, span, releases, cached is not None)
            versions += [] if cached is None else _missing_ends(span, cached)
        elif version:
            versions.append(version)
        else:
            raise UsageError("an empty version; write 1.2.3 or 1.2.0..1.4.0.")
    found = rising(versions)
    if len(found) < FEWEST:
        named = f"only {found[0]}" if found else "none"
        raise UsageError(
            f"at least two versions are needed to see a change, and {named} is named; "
            "write two or more, or a range such as 1.2.0..1.4.0."
        )
    return found, pythons


def _missing_ends(span: Span, cached: Sequence[str]) -> list[str]:
    """The ends of a range that the cache does not hold, whatever zeros they end in."""
    there = {version_of(text) for text in cached}
    return [end for end in (span.low, span.high) if version_of(end) not in there]


def _within(
    argument: str, span: Span, releases: Callable[[Span], Sequence[str]], offline: bool
) -> list[str]:
    low, high = version_of(span.low), version_of(span.high)
    if low is not None and high is not None and low > high:
        raise UsageError(f"{argument}: it ends before it starts; write {span.high}..{span.low}.")
    found = rising(releases(span))
    if not found:
        known = rising(releases(Span("", "")))
        there = f"they go from {known[0]} to {known[-1]}" if known else "there are none"
        if offline:
            raise UsageError(
                f"{argument}: the cache holds no release that lies there; of those in it "
                f"{there}; leave out --offline to install others."
            )
        raise UsageError(f"{argument}: no release for this Python lies there; {there}.")
    return found


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
