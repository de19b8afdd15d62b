"""The mean velocity of an implicit midpoint step, by Newton's method."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from omegadot.reference_impl.system import Array

MOST_ITERATIONS = 50
UNSETTLED = 0.01  # of v, a change that shrinks no further: no rounding is as large as that


def mean_velocity_of(
    push: Callable[[Array], Array],
    first: Array,
    v0: Array,
    solve: Callable[[Array], Array],
    spin: slice,
) -> Array:
    """The v_m with ``v_m = v₀ + h/2 v̇(v_m)``, (..., n).

    push: ``h/2 v̇`` at a v_m.  first: the same at v₀.  solve: by ``1 - h/2 J``, with J the Jacobian
    in v of the step's start.  spin: the velocities that are judged.
    It ends where they stand still to round-off, which may be that of an engine: a fast body's
    bias forces, ``m |v|²``, can leave far fewer digits of ω̇ than the number format has. A lane
    that has not settled comes back as NaN: its step is too large.
    """
    v = v0 + solve(first)
    eps, last = np.finfo(v.dtype).eps, np.inf
    for _ in range(MOST_ITERATIONS):
        change = solve(v0 + push(v) - v)
        v = v + change
        moved, spinning = change[..., spin], v[..., spin]
        square = np.add.reduce(spinning * spinning, -1)
        size = np.sqrt(np.add.reduce(moved * moved, -1) / np.maximum(square, 1e-300))
        # among rounding a change need not shrink each time; above it, slow is not yet settled
        least = np.where(size <= np.sqrt(eps), 0.5 * last, last)
        if np.all((size <= eps) | ~(size < least)):
            break
        last = size
    return np.where((size <= UNSETTLED)[..., None], v, np.nan)
