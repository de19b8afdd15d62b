"""Quantities of which every number is one of single precision, and how they are called."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from omegadot.diagnosis.wording.digits import listed
from omegadot.reference_impl.system import Array, State

MOTION = {"orientation": "the attitude", "angular_velocity": "omega"}
PLACES = {"position": "the position", "linear_velocity": "the linear velocity"}
IN_SINGLE = "in single precision"


def fields_in_single(came: State, due: State) -> list[str]:
    """Those that are in single precision and move, and are not to be so: states (..., n)."""
    return [
        field
        for field in (*MOTION, *PLACES)
        if _is_single(getattr(came, field)) and not _is_single(getattr(due, field))
    ]


def _is_single(values: Array) -> bool:
    """A body put to sleep has zeros, which are single numbers too."""
    rows = np.reshape(values, (-1, values.shape[-1]))
    moves = bool(np.ptp(rows, axis=0).any())
    with np.errstate(over="ignore"):  # what single precision cannot hold is not in it
        return moves and np.array_equal(rows, rows.astype(np.float32).astype(float))


def named_single(fields: Sequence[str]) -> str:
    """``the state is``, ``omega is``; places may follow from what is kept in single precision."""
    moving = [what for field, what in MOTION.items() if field in fields]
    names = moving or [what for field, what in PLACES.items() if field in fields]
    if not names:
        return ""
    text = "the state" if len(moving) == len(MOTION) else listed(names)
    return f"{text} {'are' if len(names) > 1 and not moving else 'is'}"
