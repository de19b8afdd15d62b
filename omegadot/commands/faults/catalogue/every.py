"""All faults in one place."""

from __future__ import annotations

from collections.abc import Callable

from omegadot.adapters.protocol import Setup
from omegadot.adapters.registry import BUILT_IN, build_adapter
from omegadot.commands.faults.catalogue import (  # noqa: F401  (importing them enters their faults)
    convention,
    equation,
    intermittent,
    load,
    logging,
    model,
    reporting,
    slight,
    stepping,
)
from omegadot.commands.faults.fault import FAULTS, Spoiled

KINDS = ("model", "convention", "equation", "stepping", "logging", "state")
ORDERED = sorted(FAULTS.values(), key=lambda one: KINDS.index(one.kind))
"""Every fault, kind by kind."""


def over(target: str) -> Callable[[str], Callable[..., Spoiled]]:
    """For one engine: from a fault's name to what builds the engine with that fault.

    The answer is a module's ``__getattr__``, so it raises AttributeError for other names.
    """

    def attribute(name: str) -> Callable[..., Spoiled]:
        if name not in FAULTS:
            raise AttributeError(f"there is no fault {name!r}")

        def build(setup: Setup = "physics") -> Spoiled:
            return FAULTS[name].wrap(build_adapter(target, setup))

        return build

    return attribute


def target_of(engine: str, name: str) -> str:
    """The ``module:Class`` under which a worker builds this fault over a built-in engine."""
    if engine not in BUILT_IN:
        raise KeyError(engine)
    return f"omegadot.commands.faults.over_{engine}:{name}"
