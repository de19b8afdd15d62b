"""The exact trajectories that all versions are compared with, each computed once."""

from __future__ import annotations

import threading
from dataclasses import dataclass

import numpy as np

from omegadot.gates.case import Case
from omegadot.gates.equation import random_acceleration, random_states
from omegadot.gates.measures import Yardstick
from omegadot.reference_impl.exact_solution import exact_states
from omegadot.reference_impl.growth import growth_along
from omegadot.reference_impl.system import Acceleration, Array, State

STATES = 32  # random states that the equations are evaluated at
SEED = (0, 1)


@dataclass(frozen=True)
class Exact:
    """A case's exact states at its samples, and the measure of distances from them.

    random, acceleration: where the equations are evaluated.
    """

    state: State
    growth: Array
    yardstick: Yardstick
    random: State
    acceleration: Acceleration


class Truths:
    """By case; versions that are measured side by side share them."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._known: dict[str, Exact] = {}

    def of(self, case: Case) -> Exact:
        """The truth of a case."""
        with self._lock:
            if case.name not in self._known:
                self._known[case.name] = _exact(case)
            return self._known[case.name]


def _exact(case: Case) -> Exact:
    times = case.sweeps[0].times
    _, state = exact_states(case.system, case.initial, times)
    yardstick = Yardstick(case.system, times, state)
    growth = growth_along(case.system, times, state, yardstick.rate)
    random = random_states(case, STATES, SEED)
    acceleration = random_acceleration(case.system, random, SEED)
    return Exact(state, np.asarray(growth), yardstick, random, acceleration)
