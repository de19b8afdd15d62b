"""What a run is measured by: the exact motion at the run's own samples, over the whole horizon."""

from __future__ import annotations

import math
from collections import OrderedDict
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from omegadot.commands.choose.flips import Flips
from omegadot.commands.choose.trial import Measured
from omegadot.gates.case import Case, Sweep
from omegadot.gates.measures import Yardstick
from omegadot.harness.usage import UsageError
from omegadot.reference_impl.system import Array, State
from omegadot.workers.harness_end.process import Answer

CHANNELS = {
    "attitude": "attitude",
    "omega": "omega",
    "energy-drift": "energy",
    "momentum-drift": "angular_momentum",
    "linear-momentum-drift": "linear_momentum",
}
SAMPLES_A_TURN = 24
FEWEST_SAMPLES, MOST_SAMPLES = 500, 4000
DENSEST = {"closed-form": 40_000, "series": 8_000}
KEPT = 24  # exact trajectories that are kept for the next engine that takes the same steps
Solve = Callable[[Array], Answer]


class NoTruthError(Exception):
    """There is no exact motion to measure by; the message states why."""


@dataclass(frozen=True)
class Exact:
    """The exact motion at some times, and its resolution in doubles."""

    source: str
    state: State
    omega_dot: Array
    floor: Mapping[str, Array]


class Ruler:
    """Measures one case's runs in the channels that are requested.

    solve: puts times to the exact solution. Raises NoTruthError where it does not answer.
    """

    def __init__(self, case: Case, duration: float, keys: list[str], solve: Solve) -> None:
        self.case, self.duration, self.keys = case, duration, keys
        self._solve, self._known = solve, OrderedDict[tuple[int, int], Exact]()
        speed = float(np.linalg.norm(case.initial.angular_velocity))
        self.samples = self._samples_for(speed)
        times = np.linspace(0.0, duration, 8 * self.samples + 1)
        exact = self._exact(times)
        self.source = exact.source
        self.yardstick = Yardstick(case.system, times, exact.state)
        self.samples = self._samples_for(self.yardstick.rate)
        self.flips = self._flips(times, exact)
        rounding = self.yardstick.round_off(0.0, np.zeros(1), np.ones(1))
        self._rounding = {channel: float(values[0]) for channel, values in rounding.items()}
        self.floor = {key: self._open(key, exact) for key in keys if key in CHANNELS}

    def _samples_for(self, rate: float) -> int:
        turns = rate * self.duration / (2.0 * math.pi)
        return int(min(max(SAMPLES_A_TURN * turns, FEWEST_SAMPLES), MOST_SAMPLES))

    def _flips(self, times: Array, exact: Exact) -> Flips | None:
        if "flip-time" not in self.keys:
            return None
        omega, rate = exact.state.angular_velocity, self.yardstick.rate
        flips = Flips(self.case.system, times, omega, exact.omega_dot, rate)
        if not len(flips.times):
            raise UsageError(
                f"--flip-time: omega does not change its sign along the middle axis in the "
                f"{self.duration:g} s of {self.case.name}; leave it out or give a longer duration."
            )
        return flips

    def _exact(self, times: Array) -> Exact:
        answer = self._solve(times)
        if not answer.ok:
            raise NoTruthError(f"no exact solution to measure by: {answer.reason}")
        found: dict[str, Any] = answer.result
        state = State(**found["state"])
        return Exact(found["source"], state, found["omega_dot"], found["floor"])

    def _at(self, sweep: Sweep) -> Exact:
        key = (sweep.steps, sweep.every)
        if key not in self._known:
            self._known[key] = self._exact(sweep.times)
            while len(self._known) > KEPT:
                self._known.popitem(last=False)
        return self._known[key]

    def sweep(self, steps: int, dense: bool = False) -> Sweep:
        """The horizon in so many steps, and which of them are looked at: all where `dense`."""
        samples = DENSEST[self.source] if dense else self.samples
        return Sweep(self.duration / steps, steps, max(1, math.ceil(steps / samples)))

    def _open(self, key: str, exact: Exact) -> float:
        """SI: the resolution of an error in doubles, at its largest over the horizon."""
        if key == "attitude":
            return float(np.max(exact.floor["attitude"]))
        if key == "omega":
            return float(np.max(exact.floor["angular_velocity"]))
        return self._rounding[CHANNELS[key]]

    def errors(self, sweep: Sweep, state: State) -> dict[str, Measured]:
        """The greatest errors of a run's samples. omega: rad/s; drifts: relative."""
        exact = self._at(sweep)
        found = {}
        for key in self.keys:
            if key == "flip-time":
                assert self.flips is not None
                with np.errstate(all="ignore"):
                    found[key] = self.flips.error(sweep.times, state)
                continue
            far = self.yardstick.distance(CHANNELS[key], state, exact.state)
            scale = self.yardstick.rate if key == "omega" else 1.0
            found[key] = Measured(float(np.max(far)) * scale, self.floor[key])
        return found
