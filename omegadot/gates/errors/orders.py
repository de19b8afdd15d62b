"""The order at which errors shrink with the step.

An error shows an order where it is clear of rounding and small against the motion. Late errors may
saturate, and late bounds of rounding may hide them; a shorter time is then looked at.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from omegadot.reference_impl.system import Array

Point = tuple[float, float, float, bool]

# How far an observed order may lie below the declared one where the sweep resolves it.
ORDER_TOLERANCE = 0.15
# Beyond half a radian, or half its size, an error is no longer a power of the step: it saturates.
SATURATED = 0.5
# Rounding is then a tenth of the error at most, and its bound is seldom reached.
CLEAR_OF_ROUNDING = 10.0
HORIZONS = tuple(0.5**n for n in range(7))  # of a run's samples
FEWEST_STEPS = 3  # two slopes, which must agree
FEWEST_SAMPLES = 5  # an error may be nothing at one sample, as its sign changes there
# From one sample to the next, what stepping adds may be this many times all that it added before.
LARGEST_RISE = 100.0
SATURATE, NEAR_ROUNDING = "errors saturate", "errors are close to rounding"


@dataclass(frozen=True)
class ObservedOrder:
    """The slope of log error over log step. resolved: neighbouring slopes agree.

    rise: by how much the slope rose with the last halving. Where the next term of the error is one
    order higher, what a slope lacks halves with the step, so that it is heading for
    ``value + rise``.  hidden: why errors show no order here; "" where nothing hides it.
    same: the runs of all steps are one trajectory, as where an engine takes steps of its own that
    are shorter than these.
    """

    value: float
    resolved: bool
    rise: float = 0.0
    hidden: str = ""
    same: bool = False


VANISHED = ObservedOrder(float("inf"), True)
"""Of an error that falls into rounding at the finest step: it shrinks, if too fast to measure."""


@dataclass(frozen=True)
class Errors:
    """One channel of one run: the step, and (n,) each: times, errors, and bounds of rounding.

    overall: (n,), the largest error of omega, attitude and velocity, which saturate where they are
    as large as the motion.  saturates: whether this is one of them.  signed: (n,), the errors with
    their signs, of a channel that is one number.
    """

    timestep: float
    times: Array
    size: Array
    bound: Array
    overall: Array
    saturates: bool
    signed: Array | None = None

    def largest(self, horizon: float) -> tuple[float, float, bool]:
        """Error and bound over a part of the samples, and whether errors saturate there."""
        samples = int(np.ceil(horizon * len(self.size)))
        error, bound = np.max(self.size[:samples]), np.max(self.bound[:samples])
        return float(error), float(bound), not np.max(self.overall[:samples]) <= SATURATED

    @property
    def shows(self) -> bool:
        """Whether it is clear of rounding over the whole run or a first part of it."""
        parts = map(self.largest, HORIZONS)
        return any(error > CLEAR_OF_ROUNDING * bound for error, bound, _ in parts)

    @property
    def saturates_at(self) -> int:
        """The first sample whose error saturates; the number of samples if none does."""
        beyond = ~(self.overall <= SATURATED)
        return int(np.argmax(beyond)) if beyond.any() else len(beyond)


def is_whole(order: float) -> bool:
    """Whether an order can be one: those of smooth motion are whole numbers, and 0 is no order.

    Between two of them, terms of different orders are still of a size, or the largest error has
    moved to another sample.
    """
    return abs(order - round(order)) <= ORDER_TOLERANCE


def observed_order(timesteps: Sequence[float], errors: Sequence[float]) -> ObservedOrder | None:
    """The order seen between the finest steps: ``log(e1 / e2) / log(h1 / h2)``.

    Resolved where the two finest slopes agree within the tolerance. None with fewer than two
    positive errors.
    """
    points = sorted((h, e) for h, e in zip(timesteps, errors, strict=True) if 0.0 < e < np.inf)
    if len(points) < 2:
        return None
    steps, sizes = np.log(np.array(points)).T
    slopes = np.diff(sizes) / np.diff(steps)
    resolved = len(slopes) > 1 and abs(slopes[0] - slopes[1]) <= ORDER_TOLERANCE
    rise = float(slopes[0] - slopes[1]) if len(slopes) > 1 else 0.0
    return ObservedOrder(float(slopes[0]), bool(resolved), rise)


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
            return _of_two_terms(sweep, horizon) or shown
    if shown is None or len(sweep) < FEWEST_STEPS:
        return shown
    saturated = any(errors.largest(1.0)[2] for errors in sweep)
    return replace(shown, hidden=SATURATE if saturated else NEAR_ROUNDING)


def _of_two_terms(sweep: Sequence[Errors], horizon: float) -> ObservedOrder | None:
    """The order of signed errors that are a sum of two powers, where these cancel at some samples.

    A cubic in the step goes through the errors of the four finest at every sample. Its constant is
    the error at no step, which a scheme of an order above zero has not. The order is the power of
    its first coefficient that makes a tenth of the finest error or more: with less, the slope of a
    halving would be lower by the tolerance at most. None where that is the constant or the last
    coefficient, after which others may follow, and where it may be rounding of the errors, or what
    the cubic makes of higher powers: a quartic through the five finest has less of these.
    """
    finest = sorted(sweep, key=lambda one: one.timestep)[: FEWEST_STEPS + 2]
    if len(finest) < FEWEST_STEPS + 2 or any(one.signed is None for one in finest):
        return None
    samples = min(int(np.ceil(horizon * len(one.size))) for one in finest)
    times = [one.times[:samples] / finest[0].times[-1] for one in finest]
    if not np.allclose(times, times[0], rtol=0.0, atol=1e-9):  # the samples are not the same
        return None
    errors = np.array([one.signed[:samples] for one in finest if one.signed is not None])
    ratios = np.array([one.timestep / finest[0].timestep for one in finest])
    powers = np.linalg.inv(np.vander(ratios[:-1], increasing=True))
    cubic = powers @ errors[:-1]
    quartic = np.linalg.solve(np.vander(ratios, increasing=True), errors)
    sizes = np.max(np.abs(cubic), axis=1)
    higher = np.max(np.abs(cubic - quartic[:-1]), axis=1)
    rounding = np.abs(powers) @ np.array([np.max(one.bound[:samples]) for one in finest[:-1]])
    first = int(np.argmax(sizes >= (1.0 - 0.5**ORDER_TOLERANCE) * np.max(np.abs(errors[0]))))
    known = 0 < first < 3 and sizes[first] > max(rounding[first], 2.0 * higher[first])
    return ObservedOrder(float(first), True) if known else None


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
    elif found is not None and not found.resolved:
        found = replace(found, rise=max(found.rise, _rise(sorted(points), found.value)))
    return found, enough, any(saturated for *_, saturated in points)


def _rise(points: Sequence[Point], order: float) -> float:
    """By how much an order may be rising from the finest error clear of rounding to the next.

    Terms that nearly cancel at one step leave slopes that follow no power there. The next finer
    error is close to rounding, and shows whether they rise again.
    """
    clear = next(n for n, (_, e, b, _) in enumerate(points) if e > CLEAR_OF_ROUNDING * b)
    fine, coarse = points[max(clear - 1, 0)], points[clear]
    if clear == 0 or fine[1] <= fine[2]:
        return 0.0
    most, shown = _slope_at_most(fine, coarse)
    return most - order if shown > order + ORDER_TOLERANCE else 0.0


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


def highest_order(sweep: Sequence[Errors]) -> float:
    """The highest order that rounding leaves open; infinite where it leaves all.

    An error e whose bound of rounding is b is ``e ± b`` without it, so that from e1 to the next
    finer e2 the order is ``log((e1 + b1) / (e2 - b2)) / log(h1 / h2)`` at most. It takes two such
    slopes in a row, the finer one not on its way up, over a time in which no error saturates.
    """
    found = [np.inf]
    for horizon in HORIZONS:
        if horizon * min((len(one.size) for one in sweep), default=0) < FEWEST_SAMPLES:
            break
        points = sorted((one.timestep, *one.largest(horizon)) for one in sweep)
        for three in zip(points, points[1:], points[2:], strict=False):
            if all(error > bound and not saturated for _, error, bound, saturated in three):
                found.append(_highest(*three))
    return float(min(found))


def _highest(fine: Point, middle: Point, coarse: Point) -> float:
    (one, first), (other, second) = _slope_at_most(fine, middle), _slope_at_most(middle, coarse)
    return max(one, other) if first - second <= ORDER_TOLERANCE else np.inf


def _slope_at_most(fine: Point, coarse: Point) -> tuple[float, float]:
    """The slope between two errors above rounding: as far as rounding lets it be, and as seen."""
    (h2, e2, b2, _), (h1, e1, b1, _) = fine, coarse
    ratio = np.log(h1 / h2)
    return float(np.log((e1 + b1) / (e2 - b2)) / ratio), float(np.log(e1 / e2) / ratio)
