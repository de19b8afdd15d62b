"""The slope of an error over the step, and what is known of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

# How far an observed order may lie below the declared one where the sweep resolves it.
ORDER_TOLERANCE = 0.15


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
