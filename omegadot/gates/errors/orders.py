"""The order at which errors shrink with the step.

An error shows an order where it is clear of rounding and small against the motion. Late errors may
saturate, and late bounds of rounding may hide them; a shorter time is then looked at.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from omegadot.gates.errors.highest_order import rise_of
from omegadot.gates.errors.observed_order import (
    ORDER_TOLERANCE,
    VANISHED,
    ObservedOrder,
    is_whole,
    observed_order,
)
from omegadot.gates.errors.sweep_errors import (
    CLEAR_OF_ROUNDING,
    FEWEST_STEPS,
    HORIZONS,
    LARGEST_RISE,
    SATURATED,
    Errors,
)
from omegadot.gates.errors.two_terms import of_two_terms

SATURATE, NEAR_ROUNDING = "errors saturate", "errors are close to rounding"
LATE = "late errors are sums of several powers of the step, of which earlier ones show the first"
ONE_MORE = 1.0  # order, by which two terms that nearly cancel shift a slope


def order_of(sweep: Sequence[Errors]) -> ObservedOrder | None:
    """The order over the steps of one integrator in a channel; None where none is to be seen.

    It is that of the longest time over which errors show one. `VANISHED` where an error above
    rounding is within it at the finest step. Of runs that are one trajectory the finest counts.
    """
    if _vanishes(sweep):
        return VANISHED
    distinct = _distinct(sweep)
    if 1 == len(distinct) < len(sweep):
        found = _of_trajectories(sweep)
        return found and replace(found, same=True)
    return _of_trajectories(distinct)


def _distinct(sweep: Sequence[Errors]) -> list[Errors]:
    """Without the runs that differ by rounding alone from the next finer one."""
    kept = list[Errors]()
    for one in sorted(sweep, key=lambda one: one.timestep):
        if not kept or not _is_one_trajectory(kept[-1], one):
            kept.append(one)
    return kept


def _is_one_trajectory(finer: Errors, one: Errors) -> bool:
    """Whether two errors that are clear of rounding are the same to rounding."""
    if len(finer.size) != len(one.size) or not np.any(one.size > CLEAR_OF_ROUNDING * one.bound):
        return False
    return bool(np.all(np.abs(one.size - finer.size) <= one.bound + finer.bound))


def _of_trajectories(sweep: Sequence[Errors]) -> ObservedOrder | None:
    shown = None
    for horizon in HORIZONS:
        found, clear, saturated = _over(sweep, horizon)
        # Errors that saturate show something where they do so by a jump: that is no scheme's.
        usable = not saturated or (
            found is not None and found.value <= ORDER_TOLERANCE and _jumps(sweep)
        )
        if found is not None and found.resolved and usable:
            return found
        shown = shown or (found and replace(found, resolved=False))
        if clear and not saturated:  # nothing hides the order: the errors follow no power of it
            return of_two_terms(sweep, horizon) or (shown and _late(sweep, shown))
    if shown is None or len(sweep) < FEWEST_STEPS:
        return shown
    saturated = any(errors.largest(1.0)[2] for errors in sweep)
    return replace(shown, hidden=SATURATE if saturated else NEAR_ROUNDING)


def _late(sweep: Sequence[Errors], shown: ObservedOrder) -> ObservedOrder:
    """An order that the whole time does not resolve, and a shorter one does, one higher at most."""
    for horizon in HORIZONS[1:]:
        found, _, saturated = _over(sweep, horizon)
        if found is not None and found.resolved and not saturated:
            near = 0.0 <= found.value - shown.value <= ONE_MORE
            return replace(shown, hidden=LATE) if near else shown
    return shown


def _vanishes(sweep: Sequence[Errors]) -> bool:
    """Whether an error is within rounding at the finest step, and was larger than that elsewhere.

    At fine steps, of which there are many, the bound of rounding is larger: it may hide an error.
    """
    if not sweep:  # no run of it can be measured
        return False
    finest = min(sweep, key=lambda one: one.timestep)
    if np.any(finest.size > finest.bound):
        return False
    above = [one for one in sweep if np.any(one.size > one.bound)]
    return any(np.max(one.size) > np.max(finest.bound) for one in above)


def _over(sweep: Iterable[Errors], horizon: float) -> tuple[ObservedOrder | None, bool, bool]:
    """The order over a horizon, whether enough errors are clear of rounding, and if any saturate.

    Errors close to rounding are used only where too few are clear, and then resolve nothing.
    """
    points = [(one.timestep, *one.largest(horizon)) for one in sweep]
    clear = [(h, error) for h, error, bound, _ in points if error > CLEAR_OF_ROUNDING * bound]
    enough = len(clear) >= FEWEST_STEPS
    above = [(h, error) for h, error, bound, _ in points if error > bound]
    used = clear if enough else above
    found = observed_order([h for h, _ in used], [error for _, error in used])
    if found is not None and not enough:
        found = replace(found, resolved=False)
    elif found is not None and not (found.resolved and is_whole(found.value)):
        found = replace(found, rise=max(found.rise, rise_of(sorted(points), found.value)))
    return found, enough, any(saturated for *_, saturated in points)


def _jumps(sweep: Sequence[Errors]) -> bool:
    """Whether errors saturate at the finest step from one sample to the next.

    What rounding has made by then shows by how much the motion itself makes an error grow.
    """
    finest = min(sweep, key=lambda one: one.timestep)
    at = finest.saturates_at
    if not 1 < at < len(finest.size):
        return False
    before, bound = np.max(finest.overall[:at]), finest.bound
    growth = bound[at] / bound[at - 1]
    return bool(LARGEST_RISE * growth * before < SATURATED)
