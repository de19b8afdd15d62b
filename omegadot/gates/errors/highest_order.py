"""The slopes that rounding leaves open, and the highest order among them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from omegadot.gates.errors.observed_order import ORDER_TOLERANCE
from omegadot.gates.errors.sweep_errors import (
    CLEAR_OF_ROUNDING,
    FEWEST_SAMPLES,
    HORIZONS,
    Errors,
    Point,
)


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


def rise_of(points: Sequence[Point], order: float) -> float:
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
