"""How far an engine's flips are off in time: the zeros of omega along the middle axis."""

from __future__ import annotations

import math

import numpy as np

from omegadot.commands.choose.trial import Measured
from omegadot.gates.interpolation import Hermite, error_factor, zero_crossings
from omegadot.gates.phase import middle_axis
from omegadot.gates.scales import EPS, norm
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.system import Array, State, System


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
