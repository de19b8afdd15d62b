"""The mean angular velocity of an implicit midpoint step, by Newton's method."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array

MOST_ITERATIONS = 50
UNSETTLED = 0.01  # of ω, a change that shrinks no further: no rounding is as large as that


def mean_velocity_of(
    evaluate: Callable[[Array, Acceleration], Acceleration],
    found: Acceleration,
    w0: Array,
    half: float | Array,
    inverse: Array,
) -> tuple[Array, Acceleration]:
    """The ω_m with ``ω_m = ω₀ + h/2 ω̇(ω_m)``, (..., 3), and the accelerations there.

    evaluate: the accelerations at an ω_m, given those of the iteration before.  found: those at
    ω₀.  half: ``h/2``.  inverse: of ``1 - h/2 J``, with J the Jacobian in ω of the step's start.
    It ends where ω_m stands still to round-off, which may be that of an engine: a fast body's
    bias forces, ``m |v|²``, can leave far fewer digits of ω̇ than the number format has. A lane
    that has not settled comes back as NaN: its step is too large.
    """
    w = w0 + apply(inverse, half * found.angular)
    eps, last = np.finfo(w.dtype).eps, np.inf
    for _ in range(MOST_ITERATIONS):
        found = evaluate(w, found)
        change = apply(inverse, w0 + half * found.angular - w)
        w = w + change
        size = np.sqrt(np.add.reduce(change * change, -1) / np.add.reduce(w * w, -1).clip(1e-300))
        # among rounding a change need not shrink each time; above it, slow is not yet settled
        least = np.where(size <= np.sqrt(eps), 0.5 * last, last)
        if np.all((size <= eps) | ~(size < least)):
            break
        last = size
    return np.where((size <= UNSETTLED)[..., None], w, np.nan), found
