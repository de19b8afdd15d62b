"""The companion of an engine's run: one scheme, every step of a sweep, and how rounding grows.

Each step of a sweep is stepped by itself: a single body in floats is quicker than a few lanes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from omegadot.reference_impl.coordinates import Coordinates
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.solutions.growth import growth_along
from omegadot.reference_impl.stepping import kept_steps, step_body
from omegadot.reference_impl.system import Array, State, System


@dataclass(frozen=True)
class Steps:
    """`steps` of `timestep`, of which every `every`-th and the last are kept."""

    timestep: float
    steps: int
    every: int

    @property
    def sample_steps(self) -> NDArray[Any]:
        """The step numbers that are kept: the start, every `every`-th, the end."""
        return np.array(kept_steps(self.steps, self.every))

    @property
    def times(self) -> Array:
        """(n,) s: the step numbers times the step, the contract's sample times."""
        return self.sample_steps * self.timestep


@dataclass(frozen=True)
class CompanionRun:
    """time: (n,) s.  state: (n, ...).  growth: (n,), how rounding grows along these states."""

    time: Array
    state: State
    growth: Array


def companion(
    system: System,
    initial: State,
    scheme: str,
    rate: float,
    plan: Sequence[Steps],
    coordinates: Coordinates = "com-world",
) -> list[CompanionRun]:
    """The reference stepping `scheme` from `initial`, once per entry of `plan`.

    rate: rad/s, the scale by which changes of omega are measured against changes of attitude.
    coordinates: those in which a free body is stepped.
    """
    found = []
    for run in plan:
        how = (run.timestep, run.steps, run.every, coordinates)
        times, state = step_body(SCHEMES[scheme], system, initial, *how)
        found.append(CompanionRun(times, state, growth_along(system, times, state, rate)))
    return found
