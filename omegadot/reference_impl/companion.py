"""The reference beside an engine: one scheme, every step of a sweep, and how rounding grows.

The steps of a sweep are lanes of one array, so that a whole sweep costs little more than its
longest run.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import gcd
from typing import Any

import numpy as np
from numpy.typing import NDArray

from omegadot.reference_impl.coordinates import Coordinates
from omegadot.reference_impl.growth import growth_along
from omegadot.reference_impl.schemes import SCHEMES, Scheme
from omegadot.reference_impl.stepping import kept_steps, step_body
from omegadot.reference_impl.system import Array, State, System

# Lanes share their samples; beyond this many rows it is cheaper to run each step by itself.
MOST_SHARED_ROWS = 20_000


@dataclass(frozen=True)
class Steps:
    """`steps` of `timestep`, of which every `every`-th and the last are kept."""

    timestep: float
    steps: int
    every: int

    @property
    def kept(self) -> NDArray[Any]:
        """The numbers of the steps that are kept."""
        return np.array(kept_steps(self.steps, self.every))


@dataclass(frozen=True)
class CompanionRun:
    """time: (n,) s.  state: (n, ...).  growth: (n,), how rounding grows along these states."""

    time: Array
    state: State
    growth: Array


def _run_together(
    system: System, scheme: Scheme, initial: State, coordinates: Coordinates, plan: Sequence[Steps]
) -> list[State]:
    """All of `plan` as lanes; samples are kept where any of them needs one."""
    every = gcd(*(n for step in plan for n in (step.every, step.steps)))
    longest = max(step.steps for step in plan)
    timesteps = np.array([step.timestep for step in plan])
    _, states = step_body(scheme, system, initial, timesteps, longest, every, coordinates)
    return [
        State(*(field[step.kept // every, lane] for field in vars(states).values()))
        for lane, step in enumerate(plan)
    ]


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
    shared = gcd(*(n for step in plan for n in (step.every, step.steps)))
    longest = max(step.steps for step in plan)
    groups = [plan] if longest // shared <= MOST_SHARED_ROWS else [[step] for step in plan]
    named = SCHEMES[scheme]
    states = [
        s for group in groups for s in _run_together(system, named, initial, coordinates, group)
    ]
    return [
        CompanionRun(times, state, growth_along(system, times, state, rate))
        for times, state in zip((s.kept * s.timestep for s in plan), states, strict=True)
    ]
