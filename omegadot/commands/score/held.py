"""Components that stand still where the motion does not: saturated sensors, and stale values."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.commands.score.columns import GROUPS
from omegadot.commands.score.measured import Measured
from omegadot.commands.score.settings import Reading
from omegadot.reference_impl.system import Array

FEWEST = 3  # samples in a row
LONG = 8  # of a value that is no extreme


@dataclass(frozen=True)
class Held:
    """A column that keeps a value. first, last: the samples of its longest stretch.

    value: in the trace's own unit.  count: of samples in all such stretches.
    kind: "throughout", "largest", "smallest" or "between", what the value is of the column's.
    """

    column: str
    value: float
    first: int
    last: int
    count: int
    kind: str


def runs_of(values: Array) -> tuple[Array, Array]:
    """Where each run of equal values begins, and how long it is."""
    starts = np.concatenate(([0], np.flatnonzero(np.diff(values)) + 1))
    return starts, np.diff(np.append(starts, len(values)))


def held_channels(found: Measured, reading: Reading) -> list[Held]:
    """The columns of omega that keep a value while the exact omega changes by more than digits.

    Of a column's largest and smallest value three samples in a row are enough, of another eight.
    """
    omega, frame = found.trace.angular_velocity, reading.how
    if omega is None or frame.omega_frame != "body" or not _plain(frame.body_axes):
        return []
    places = np.argmax(np.abs(frame.body_axes), axis=0)
    listed = []
    for axis, role in enumerate(GROUPS["w"]):
        if role in reading.columns:
            column = reading.table.column(reading.columns[role])
            exact = found.truth.state.angular_velocity[:, places[axis]]
            opened = found.rate * found.bound["omega"]
            listed += _held(reading.columns[role], column.values, exact, opened)
    return listed


def _plain(axes: Array) -> bool:
    return bool(np.all(np.isin(axes, (-1.0, 0.0, 1.0))))


def _held(name: str, values: Array, exact: Array, opened: Array) -> list[Held]:
    """The column's longest such stretch."""
    best, count = None, 0
    for start, length in zip(*runs_of(values), strict=True):
        stretch = slice(start, start + length)
        value = values[start]
        extreme = value in (np.max(values), np.min(values))
        moved = float(np.ptp(exact[stretch])) > 4.0 * float(np.max(opened[stretch]))
        if moved and length >= (FEWEST if extreme else LONG):
            count += int(length)
            if best is None or length > best[1]:
                best = start, length, value
    if best is None:
        return []
    start, length, value = best
    kinds = {"throughout": length == len(values), "largest": value == np.max(values)}
    kinds["smallest"] = value == np.min(values)
    kind = next((kind for kind, holds in kinds.items() if holds), "between")
    return [Held(name, float(value), int(start), int(start + length - 1), count, kind)]
