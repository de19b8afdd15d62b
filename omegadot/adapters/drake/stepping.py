"""Drake's simulator, stepping from sample to sample in native code.

A `VectorLogSink` would keep Python out altogether, and costs more: it needs a diagram, in which a
step takes a quarter longer than in a plant alone.
"""

from __future__ import annotations

from time import perf_counter
from typing import Any

import numpy as np

from omegadot.adapters.drake.model import DrakeModel
from omegadot.adapters.protocol import UnsupportedError
from omegadot.reference_impl.system import Array

LOOKED_AT = 64  # samples between two looks at whether a run is still finite
SINGULAR = (
    "has reached a singularity"  # of the message in which Drake refuses a pitch of 90 degrees
)
# A ball joint of quaternions is wanted there, and is not to be had.
NO_OTHER_JOINT = "https://github.com/RobotLocomotion/drake/issues/12404"
ROOT_OF_LARGEST = 2.0**512  # the least number whose square is not finite


class DrakeStepper:
    """A simulator of a model, in a context of its own, that begins at these coordinates."""

    def __init__(self, drake: Any, model: DrakeModel, start: Array) -> None:
        self._drake, self._plant, self._start = drake, model.plant, start
        root, self._own = model.context()
        model.plant.SetPositionsAndVelocities(self._own, start)
        self._simulator = drake.Simulator(model.root, root)

    def integrate(self, scheme: str, most: float) -> Any:
        """The simulator's integrator of this name; most: s, of a step."""
        return self._drake.ResetIntegratorFromFlags(self._simulator, scheme, most)

    def run(self, times: Array) -> tuple[Array, float]:
        """Coordinates (n, k) at the start and at these times in s, and the s that steps took.

        A run that is no longer finite is not gone on with: its later rows are NaN.
        """
        own, advance = self._own, self._simulator.AdvanceTo
        state, rows = self._plant.GetPositionsAndVelocities, [self._start]
        self._simulator.Initialize()
        began = perf_counter()
        try:
            for first in range(0, len(times), LOOKED_AT):
                for end in times[first : first + LOOKED_AT].tolist():
                    advance(end)
                    rows.append(state(own))
                if not is_finite(rows[-1]):
                    break
        except RuntimeError as error:
            refuse(error, rows[-1])
        seconds = perf_counter() - began
        found = np.full((len(times) + 1, len(self._start)), np.nan)
        found[: len(rows)] = rows
        return found, seconds


def is_finite(row: Array) -> bool:
    """Whether coordinates are finite, and their squares."""
    return bool(np.all(np.abs(row) < ROOT_OF_LARGEST))


def refuse(error: RuntimeError, last: Array) -> None:
    """Raise the error again, unless the coordinates that it stopped at are not finite."""
    reason = " ".join(str(error).split())
    if SINGULAR in reason:
        raise UnsupportedError(
            "Drake's ball joint has roll, pitch and yaw, and this motion takes its pitch to 90 "
            f"degrees, where BallRpyJoint refuses to step ({NO_OTHER_JOINT})"
        ) from error
    if is_finite(last):
        raise error


def refuse_unresolved(rows: Array, timestep: float) -> None:
    """Raise UnsupportedError where a step turns further than a ball joint's singularity is away.

    rows: (n, 6), roll, pitch, yaw and omega after each step. ``roll' = (..) / cos(pitch)`` has a
    pole in time, at ``cos(pitch) / |omega|`` from here at the least. A longer step is beyond what
    any power series of the motion holds for, so that no order shows, and multiplies the rounding
    of the angles by ``h |omega| / cos(pitch)^2``.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        turns = timestep * np.linalg.norm(rows[:, 3:], axis=1)
        away = np.abs(np.cos(rows[:, 1]))
    if np.any(turns > away):
        raise UnsupportedError(
            "Drake's ball joint has roll, pitch and yaw, and a step turns further than the motion "
            "is away from a pitch of 90 degrees, where these are singular; take smaller steps "
            f"({NO_OTHER_JOINT})"
        )
