"""Quantities of which every number is one of single precision, and how they are called."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from omegadot.diagnosis.wording.digits import listed
from omegadot.gates.bounds.scales import EPS
from omegadot.reference_impl.system import Array, State

MOTION = {"orientation": "the attitude", "angular_velocity": "omega"}
PLACES = {"position": "the position", "linear_velocity": "the linear velocity"}
NEAR = 3  # units in the last place by which making it unit may change the largest part
ROUNDINGS = 4.0
FEWEST = 4  # numbers, more than a vector has
IN_SINGLE = "in single precision"


def fields_in_single(came: State, due: State) -> list[str]:
    """Those that are in single precision and move, and are not to be so: states (..., n)."""
    return [
        field
        for field in (*MOTION, *PLACES)
        if _in_single(field, came) and not _in_single(field, due)
    ]


def _in_single(field: str, states: State) -> bool:
    values = getattr(states, field)
    return _is_single(values) or (field == "orientation" and _is_single_made_unit(values))


def _is_single(values: Array) -> bool:
    """What stays as it was given, and the zeros of a body put to sleep, are single numbers too."""
    rows = np.reshape(values, (-1, values.shape[-1]))
    moves = len(np.unique(np.abs(rows[rows != 0.0]))) >= FEWEST
    with np.errstate(over="ignore"):  # what single precision cannot hold is not in it
        return moves and np.array_equal(rows, rows.astype(np.float32).astype(float))


def _is_single_made_unit(quaternions: Array) -> bool:
    """Whether each is a quaternion of single numbers, made unit in double precision.

    Its largest part is one of these within few units in the last place, and so are the others at
    that length.
    """
    rows = np.reshape(quaternions, (-1, 4))
    several = np.count_nonzero(rows, axis=-1) > 1
    lengths = np.sqrt(np.sum(rows * rows, axis=-1))
    unit = bool(np.all(np.abs(lengths - 1.0) <= ROUNDINGS * EPS))
    if not unit or not np.ptp(rows, axis=0).any() or not np.any(several):
        return False
    rows = rows[several]
    most = np.max(np.abs(rows), axis=-1, keepdims=True)
    near, found = most.astype(np.float32), np.zeros(len(rows), bool)
    for count in range(-NEAR, NEAR + 1):
        whole = rows * ((near + count * np.spacing(near)).astype(float) / most)
        off = np.abs(whole - whole.astype(np.float32).astype(float))
        found |= np.all(off <= ROUNDINGS * EPS * most, axis=-1)
    return bool(np.all(found))


def named_single(fields: Sequence[str]) -> str:
    """``the state is``, ``omega is``; places may follow from what is kept in single precision."""
    moving = [what for field, what in MOTION.items() if field in fields]
    names = moving or [what for field, what in PLACES.items() if field in fields]
    if not names:
        return ""
    text = "the state" if len(moving) == len(MOTION) else listed(names)
    return f"{text} {'are' if len(names) > 1 and not moving else 'is'}"
