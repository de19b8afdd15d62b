"""What a run is measured by: the exact motion at the run's own samples, over the whole horizon."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from omegadot.commands.choose.trial import Measured
from omegadot.gates.bounds.measures import Yardstick
from omegadot.gates.bounds.scales import EPS, norm
from omegadot.gates.case import Case, Sweep
from omegadot.gates.runs.interpolation import Hermite, error_factor, zero_crossings
from omegadot.gates.runs.phase import middle_axis
from omegadot.harness.usage import UsageError
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.system import Array, State, System
from omegadot.workers.harness_end.process import Answer
from omegadot.written import written


class Flips:
    """The flips of one exact motion.

    times, omega, omega_dot: the exact motion, sampled much more densely than it turns.
    rate: rad/s, its greatest |omega|.
    """

    def __init__(self, system: System, times: Array, omega: Array, omega_dot: Array, rate: float):
        self._system, self._end = system, float(times[-1])
        self._curve = Hermite(times, omega, omega_dot)
        axis = middle_axis(system)
        self.times: Array = np.empty(0)
        self.axis: Array = np.zeros(3) if axis is None else axis
        if not np.max(np.abs(omega @ self.axis)) > 64 * EPS * rate:
            return
        self.times = zero_crossings(times, omega @ self.axis, omega_dot @ self.axis)
        with np.errstate(divide="ignore"):
            slopes = np.abs(self._curve.at(self.times)[1] @ self.axis)
            self._seconds = float(np.max(1.0 / slopes, initial=0.0))

    def error(self, times: Array, state: State) -> Measured:
        """The greatest error in time, flip by flip; infinite where one is missing or too many.

        A flip that lies within the error of the end of the horizon may fall on either side of it.
        open: what the cubic between an engine's own samples leaves open, ``h^4 w'''' / 384``, over
        the slope.
        """
        slopes = forward_dynamics(self._system, state).angular
        found = zero_crossings(times, state.angular_velocity @ self.axis, slopes @ self.axis)
        count = min(len(found), len(self.times))
        value = float(np.max(np.abs(found[:count] - self.times[:count]), initial=0.0))
        rest = np.concatenate([found[count:], self.times[count:]])
        if len(rest):
            late = float(self._end - rest[0])
            value = max(value, late) if count and len(rest) == 1 else math.inf
        bend = self._bend(times, slopes) if len(times) > 5 else math.inf
        return Measured(value, error_factor(0.5) * bend * self._seconds)

    @staticmethod
    def _bend(times: Array, slopes: Array) -> float:
        """rad/s: the gap to the fourth times omega's fourth derivative, by differences."""
        gap = float(times[1] - times[0])
        third = np.diff(slopes[:-1], 3, axis=0)
        with np.errstate(all="ignore"):
            return gap * float(np.max(norm(third)) + np.max(norm(np.diff(third, axis=0))))


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
        self._solve = solve
        self._along = lru_cache(KEPT)(lambda sweep: self._exact(sweep.times))
        speed = float(np.linalg.norm(case.initial.angular_velocity))
        self.samples = self._samples_for(speed)
        times = np.linspace(0.0, duration, 8 * self.samples + 1)
        exact = self._exact(times)
        self.source = exact.source
        self.yardstick = Yardstick(case.system, times, exact.state)
        self.samples = self._samples_for(self.yardstick.rate)
        self.flips = self._flips(times, exact)
        # SI: the resolution of an error in doubles, at its largest over the horizon.
        floors = self.yardstick.round_off(0.0, np.zeros(1), np.ones(1))
        floors |= {"attitude": exact.floor["attitude"], "omega": exact.floor["angular_velocity"]}
        known = [key for key in keys if key in CHANNELS]
        self.floor = {key: float(np.max(floors[CHANNELS[key]])) for key in known}

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
                f"{written(self.duration)} s of {self.case.name}; leave it out or give a longer "
                "duration."
            )
        return flips

    def _exact(self, times: Array) -> Exact:
        answer = self._solve(times)
        if not answer.ok:
            raise NoTruthError(f"the exact trajectory cannot be worked out: {answer.reason}")
        found: dict[str, Any] = answer.result
        state = State(**found["state"])
        return Exact(found["source"], state, found["omega_dot"], found["floor"])

    def sweep(self, steps: int, dense: bool = False) -> Sweep:
        """The horizon in so many steps, and which of them are looked at: all where `dense`."""
        samples = DENSEST[self.source] if dense else self.samples
        return Sweep(self.duration / steps, steps, max(1, math.ceil(steps / samples)))

    def errors(self, sweep: Sweep, state: State) -> dict[str, Measured]:
        """The greatest errors of a run's samples. omega: rad/s; drifts: relative."""
        exact = self._along(sweep)
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
