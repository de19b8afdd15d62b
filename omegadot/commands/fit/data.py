"""A trace in the units of the fit, and what a motion leaves of it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from omegadot.commands.fit.motion import motion
from omegadot.commands.fit.parameters import Parameters
from omegadot.reference_impl.rotations import rotation_between
from omegadot.reference_impl.system import Array

MOST_RATES = 400  # evaluations a unit of time, about a radian: a tolerance of 1e-12 needs 60
RIDGE = 1e-6


@dataclass(frozen=True)
class Data:
    """A trace in the units of the fit.

    times: (n,) from zero.  omega: (n, 3).  orientation: (n, 4), or None where it is not given.
    torque: (3,), body axes; zero where none is known.  turn_weight: that of a rad of attitude where
    one of omega is 1.  tolerance: relative, of the motion.  ridge: the weight of what pulls bias,
    damping and turn to zero.
    """

    times: Array
    omega: Array
    orientation: Array | None
    torque: Array
    turn_weight: float = 1.0
    tolerance: float = 1e-9
    ridge: float = RIDGE

    def until(self, count: int) -> Data:
        """The first samples alone."""
        turned = None if self.orientation is None else self.orientation[:count]
        return replace(self, times=self.times[:count], omega=self.omega[:count], orientation=turned)

    @property
    def turned(self) -> Array:
        """(n,) rad, by how much the body has turned."""
        speed = np.linalg.norm(self.omega, axis=1)
        steps = 0.5 * (speed[1:] + speed[:-1]) * np.diff(self.times)
        return np.concatenate(([0.0], np.cumsum(steps)))

    def residuals(self, lanes: Parameters) -> Array:
        """(k, 3n) or (k, 6n): what the motion of each lane leaves of omega, then of attitude."""
        turning = self.orientation is not None
        most = int(MOST_RATES * (1.0 + self.times[-1]))
        omega, orientation = motion(lanes, self.torque, self.times, turning, self.tolerance, most)
        count = len(omega)
        left = (self.omega - omega - lanes.bias[:, None]).reshape(count, -1)
        if self.orientation is None:
            return left
        turns = rotation_between(orientation, np.broadcast_to(self.orientation, orientation.shape))
        return np.hstack([left, self.turn_weight * turns.reshape(count, -1)])
