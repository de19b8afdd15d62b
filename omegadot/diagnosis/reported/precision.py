"""Causes in the numbers of a run: of single precision, packed, or of a few decimal digits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.reported.singles import IN_SINGLE, MOTION, fields_in_single, named_single
from omegadot.gates.bounds.scales import EPS
from omegadot.gates.runs.trajectory import grain_of
from omegadot.reference_impl.system import Array, State

HALF_A_DIGIT = 0.5 * float(np.finfo(np.float32).eps)
MOST_DECIMALS = 11
DECIMAL = {
    "angular_velocity": "omega",
    "orientation": "the attitude",
    "position": "the position",
    "linear_velocity": "the linear velocity",
}
BITS = range(6, 25)  # of the integers that an attitude may be packed in, without the sign
LEAST_PACKED = 4  # samples whose quaternion has two parts or more
ROUNDINGS = 64.0  # of a product, a sum of four squares, its root and a quotient, with room
MOST_DIGITS = 15  # seventeen determine every double, and sixteen most


def precision_reported(reported: ReportedRun) -> str:
    """Attitude or omega of every sample after the start are numbers of single precision.

    Places may follow, in double, from what is kept; where they alone are single, it is they that
    are so reported or kept. Numbers that are all multiples of one step are rounded to it, whatever
    their size.
    """
    if rounded := _grain_reported(reported) or _packed_reported(reported):
        return rounded
    if reported.truth.yardstick.eps > EPS:
        return ""  # it is due
    single = fields_in_single(reported.state[1:], reported.own[1:])
    named = named_single(single)
    if not named:
        return ""
    if not _is_own_in_single(reported, single):
        return f"{named} kept {IN_SINGLE}"
    return f"{named} reported {IN_SINGLE}" + ", and kept in double" * bool({*single} & {*MOTION})


def _is_own_in_single(reported: ReportedRun, single: Sequence[str]) -> bool:
    """Whether the reference's run differs by the rounding of what is logged, and by no more.

    What is kept in single precision adds its roundings up, and other quantities follow it.
    """
    pairs = {f: (getattr(reported.state, f)[1:], getattr(reported.own, f)[1:]) for f in single}
    for field, (came, own) in pairs.items():
        rounding = ROUNDINGS * EPS * float(np.max(np.abs(own)))
        digits = 2.0 * HALF_A_DIGIT if field == "orientation" else HALF_A_DIGIT  # if made unit
        if not np.all(np.abs(came - own) <= digits * np.abs(own) + rounding):
            return False
    others = replace(reported.state, **{field: getattr(reported.own, field) for field in single})
    return reported.agrees(others, reported.own)


def _grain_reported(reported: ReportedRun) -> str:
    for field, what in (("angular_velocity", "omega"), ("orientation", "the attitude")):
        came, own = (getattr(x, field)[1:] for x in (reported.state, reported.own))
        # a number that is reported again and again shows its last digits once
        if (grain := grain_of(np.unique(came))) is not None and grain_of(own) != grain:
            return f"{what} is rounded to multiples of 2^{grain} in the run"
    return ""


def _packed_reported(reported: ReportedRun) -> str:
    """Every quaternion is one of whole numbers, up to a power of two or one less, made unit.

    Some scale s of a unit quaternion makes all its parts whole; s is a whole number over its
    largest part, near the largest number that the integers hold. Where none of that many numbers
    lies within rounding of a whole one by chance, this needs two parts that are not zero.
    """
    came, own = (x.orientation[1:] for x in (reported.state, reported.own))
    several = np.count_nonzero(np.abs(came) > 2.0 ** -BITS[0], axis=-1) > 1
    if np.count_nonzero(several) < LEAST_PACKED:
        return ""
    for bits in BITS:
        for most in (2**bits - 1, 2**bits):
            if np.all(_is_packed(came, most)) and not np.all(_is_packed(own[several], most)):
                return (
                    f"the attitude is packed in integers of {bits + 1} bits in the run: its parts "
                    f"are as whole numbers of up to 2^{bits}"
                )
    return ""


def _is_packed(quaternions: Array, most: int) -> NDArray[np.bool_]:
    """(n,): whether each is a quaternion of whole numbers, of about this length, made unit."""
    largest = np.max(np.abs(quaternions), axis=-1, keepdims=True)
    found = np.zeros(len(quaternions), bool)
    for near in range(-2, 3):  # the length of four rounded parts is within one of what it was
        with np.errstate(all="ignore"):
            whole = quaternions * ((np.round(largest * most) + near) / largest)
            off = np.max(np.abs(whole - np.round(whole)), axis=-1)
        found |= off <= ROUNDINGS * EPS * most
    return found


def decimals_reported(reported: ReportedRun) -> str:
    """A quantity whose every number after the start is one of a few decimals."""
    for name, what in DECIMAL.items():
        came, own = (getattr(x, name)[1:] for x in (reported.state, reported.own))
        for digits in range(1, MOST_DECIMALS):
            if np.max(np.spacing(np.abs(came))) > 0.1 ** (digits + 1):
                break  # numbers so large have no more decimals
            rounded = np.round(came, digits)
            if np.array_equal(rounded, came) and len(np.unique(came)) > came.size // 2:
                if np.any(np.round(own, digits) != own):
                    return f"{what} is rounded to {digits} decimals in the run"
                break
    return ""


def digits_reported(reported: ReportedRun) -> str:
    """Every number of the run is one of a few decimal digits; all are finite."""
    digits = _digits(reported.state)
    if digits > MOST_DIGITS or _digits(reported.own) <= digits:
        return ""
    return f"the numbers of the run have {digits} digits: they went through text"


def _digits(state: State) -> int:
    """How many significant digits determine all numbers of these states."""
    numbers, needed = np.concatenate([np.ravel(values) for values in vars(state).values()]), 1
    for number in numbers.tolist():
        while needed < MOST_DIGITS + 2 and float(f"{number:.{needed}g}") != number:
            needed += 1
    return needed
