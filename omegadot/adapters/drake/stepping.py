"""Drake's simulator, which steps, and logs every step or every sample, in native code."""

from __future__ import annotations

from time import perf_counter
from typing import Any

import numpy as np

from omegadot.adapters.drake.model import DrakeModel
from omegadot.adapters.protocol import UnsupportedError
from omegadot.reference_impl.system import Array

CHUNK = 256  # steps from one look at the log to the next
SINGULAR = (
    "has reached a singularity"  # of the message in which Drake refuses a pitch of 90 degrees
)
ROOT_OF_LARGEST = 2.0**512  # the least number whose square is not finite


class DrakeStepper:
    """A simulator of a model, in a context of its own, that begins at these coordinates."""

    def __init__(self, drake: Any, model: DrakeModel, start: Array) -> None:
        self._drake, self._model, self._start = drake, model, start
        self._root, own = model.context()
        model.plant.SetPositionsAndVelocities(own, start)
        self._simulator = drake.Simulator(model.diagram, self._root)

    def integrate(self, scheme: str, most: float) -> Any:
        """The simulator's integrator of this name; most: s, of a step."""
        return self._drake.ResetIntegratorFromFlags(self._simulator, scheme, most)

    def run(self, ends: Array, rows_to: Array) -> tuple[Array, float]:
        """The log (n, k) up to the end, and s that it took.

        ends: s, times up to which to go.  rows_to: how many rows the log then has. A run that is no
        longer finite is not gone on with: later rows are NaN.
        """
        log = self._model.log.FindMutableLog(self._root)
        found = np.full((int(rows_to[-1]), len(self._start)), np.nan)
        found[0] = self._start
        began, first = perf_counter(), 0
        self._simulator.Initialize()
        for end, last in zip(ends.tolist(), rows_to.tolist(), strict=True):
            try:
                self._simulator.AdvanceTo(end)
            except RuntimeError as error:
                refuse(error, log.data())
                break
            data = log.data().T
            if len(data) != last - first:
                raise RuntimeError(f"Drake logged {first + len(data)} rows instead of {last}")
            found[first:last], first = data, last
            log.Clear()
            if not is_finite(data[-1]):
                break
        return found, perf_counter() - began


def is_finite(row: Array) -> bool:
    """Whether coordinates are finite, and their squares."""
    return bool(np.all(np.abs(row) < ROOT_OF_LARGEST))


def refuse(error: RuntimeError, rows: Array) -> None:
    """Raise the error again, unless the coordinates that it stopped at are not finite."""
    reason = " ".join(str(error).split())
    if SINGULAR in reason:
        raise UnsupportedError(
            "Drake's ball joint has roll, pitch and yaw, and this motion takes its pitch to 90 "
            "degrees, where BallRpyJoint refuses to step"
        ) from error
    if rows.size == 0 or is_finite(rows[:, -1]):
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
    beyond = turns > away
    if np.any(beyond):
        first = int(np.argmax(beyond))
        raise UnsupportedError(
            f"Drake's ball joint has roll, pitch and yaw, and in steps of {turns[first]:.2g} rad "
            f"this motion comes {away[first]:.2g} rad near a pitch of 90 degrees, where these are "
            "singular; take smaller steps"
        )
