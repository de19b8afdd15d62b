"""Whether each step's error follows from those at finer steps by an order."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from omegadot.gates.errors.sweep_errors import (
    CLEAR_OF_ROUNDING,
    FEWEST_SAMPLES,
    HORIZONS,
    LARGEST_RISE,
    SATURATED,
    Errors,
)
from omegadot.reference_impl.system import Array

Known = tuple[Array, NDArray[np.bool_]]

EXCESS_ORDERS = 3.0  # by which an error may exceed what finer steps and their order explain


def excess_of(own: Errors, sweep: Sequence[Errors], declared: int) -> float:
    """How many times larger a step's error is than the errors at other steps let it be.

    With e1, e2, e3 at the next finer steps the error follows from e1 by an order: the declared one,
    or the slope s12 from e1 to e2 where that is higher. It may be three orders more, since leading
    terms may nearly cancel, and a slope may differ from the next by four times what that differs
    from the one after. This must hold up to where the error saturates, and up to parts of that
    time; there e1 is the largest up to twice that time, as an error may pass through nothing. It
    may do so as the step changes: e1 is at least what e2 is by the declared order, where e2 is
    above rounding. A finer step whose own error does not follow explains no other. Nor may the
    error be more than 100 times that of a coarser step: no order makes it larger.
    """
    finer = sorted((one for one in sweep if one.timestep < own.timestep), key=lambda e: e.timestep)
    kept = list[Errors]()
    for one in finer:
        if _beyond(one, kept, declared) <= 1.0:
            kept.append(one)
    return max(_beyond(own, kept, declared), _beside_coarser(own, sweep))


def _beside_coarser(own: Errors, sweep: Sequence[Errors]) -> float:
    """By how much an error is more than 100 times that of some coarser step, over the same time."""
    count = min(own.saturates_at + own.saturates, len(own.size))
    if count < FEWEST_SAMPLES:
        return 0.0
    error = float(np.max(own.size[:count]))
    error = min(error, SATURATED) if own.saturates else error
    least = CLEAR_OF_ROUNDING * float(np.max(own.bound[:count]))
    if not error > least:
        return 0.0
    until = own.times[count - 1 : count]
    coarser = [one for one in sweep if one.timestep > own.timestep and len(one.size)]
    smallest = min((float(_at(one, until)[0][0]) for one in coarser), default=np.inf)
    allowed = max(LARGEST_RISE * smallest, least)
    return error / allowed if allowed > 0.0 else np.inf


def _beyond(own: Errors, finer: Sequence[Errors], declared: int) -> float:
    """By how much an error is more than finer steps let it be; zero without any. finer: by step."""
    finer = finer[::-1]
    count = min(own.saturates_at + own.saturates, len(own.size))
    if not finer or count == 0:
        return 0.0
    ends = np.unique([max(FEWEST_SAMPLES, round(part * count)) for part in HORIZONS])
    ends = np.minimum(ends, count) - 1
    until = own.times[ends]
    near = [_at(one, until) for one in finer[:3]]
    later = np.minimum(2.0 * until, own.times[count - 1])
    e1, _ = _at(finer[0], later)
    if len(finer) > 1:
        ratio = finer[0].timestep / finer[1].timestep
        e1 = np.maximum(e1, ratio**declared * _above_rounding(finer[1], later))
    order = np.full(len(ends), float(declared))
    if len(near) > 1:
        first = _slopes(finer[0], finer[1], near[0], near[1])
        second = np.full(len(ends), np.nan)
        if len(near) > 2:
            second = _slopes(finer[1], finer[2], near[1], near[2])
        second = np.where(np.isnan(second), np.fmin(first, declared), second)
        change = 4.0 * np.abs(first - second)
        # What is hidden by rounding at one time may show at another.
        order = np.maximum(order, np.max(first, where=~np.isnan(first), initial=declared))
        order = np.where(np.isnan(first), order, np.maximum(first, declared) + change)
    error = own.until[0, ends]
    if own.saturates:
        error = np.minimum(error, SATURATED)
    least = CLEAR_OF_ROUNDING * own.until[1, ends]
    with np.errstate(all="ignore"):
        allowed = e1 * (own.timestep / finer[0].timestep) ** (order + EXCESS_ORDERS)
        excess = error / np.maximum(allowed, least)
    return float(np.max(np.nan_to_num(excess, nan=0.0, posinf=np.inf)))


def _slopes(one: Errors, finer: Errors, e1: Known, e2: Known) -> Array:
    """(n,): the order from one step to a finer one; NaN where an error is not above rounding."""
    with np.errstate(all="ignore"):
        slopes = np.log(e1[0] / e2[0]) / np.log(one.timestep / finer.timestep)
    return np.where(e1[1] & e2[1], slopes, np.nan)


def _above_rounding(errors: Errors, until: Array) -> Array:
    """(n,): the largest error up to each of these times; zero where it is within rounding."""
    place = np.searchsorted(errors.times, until * (1.0 + 1e-9), side="right") - 1
    size, bound, _ = errors.until[:, place]
    return np.where(size > bound, size, 0.0)


def _at(errors: Errors, until: Array) -> Known:
    """The largest error up to each of these times, at least ten times its bound, and if above it.

    Below that nothing is known of an error but that it is no larger.
    """
    place = np.searchsorted(errors.times, until * (1.0 + 1e-9), side="right") - 1
    size, bound, _ = errors.until[:, place]
    least = CLEAR_OF_ROUNDING * bound
    return np.maximum(size, least), size > least
