"""Every fault over every built-in engine, as attributes: ``over:dart_GyroscopicDropped``.

A worker builds the engine with the fault from such a ``module:Class``.
"""

from __future__ import annotations

from collections.abc import Callable

from omegadot.adapters.protocol import Setup
from omegadot.adapters.registry import BUILT_IN, build_adapter
from omegadot.commands.faults.catalogue.every import ORDERED
from omegadot.commands.faults.fault import Spoiled

BY_NAME = {fault.name: fault for fault in ORDERED}


def target_of(engine: str, name: str) -> str:
    """The ``module:Class`` under which a worker builds this fault over a built-in engine."""
    if engine not in BUILT_IN:
        raise KeyError(engine)
    return f"{__name__}:{engine}_{name}"


def __getattr__(name: str) -> Callable[..., Spoiled]:
    """What builds an engine with a fault. Raises AttributeError for other names."""
    engine, _, fault = name.partition("_")
    if engine not in BUILT_IN or fault not in BY_NAME:
        raise AttributeError(f"there is no fault {name!r}")

    def build(setup: Setup = "physics") -> Spoiled:
        return BY_NAME[fault].wrap(build_adapter(BUILT_IN[engine], setup))

    return build
