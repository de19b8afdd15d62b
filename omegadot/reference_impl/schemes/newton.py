"""The mean velocity of an implicit midpoint step, by Newton's method."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

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
    h: float | Array | None = None,
) -> Array:
    """The v_m with ``v_m = v₀ + h/2 v̇(v_m)``, (..., n).

    push: ``h/2 v̇`` at a v_m.  first: the same at v₀.  solve: by ``1 - h/2 J``, with J the Jacobian
    in v of the step's start.  spin: the angular velocities; the others, where there are any, are
    judged apart, since in body axes they may settle later.  h: the step, s.
    It ends where both stand still to round-off, which may be that of an engine: a fast body's
    bias forces, ``m |v|²``, can leave far fewer digits of ω̇ than the number format has. A lane
    that has not settled comes back as NaN: its step is too large.
    """
    v = v0 + solve(first)
    eps, last, before = _eps(v.dtype), np.inf, np.inf
    rest = _others(spin, v.shape[-1])
    for _ in range(MOST_ITERATIONS):
        change = solve(v0 + push(v) - v)
        v = v + change
        size = _relative(change, v, spin)
        still = _stands_still(size, last, eps)
        if rest is not None and _all(still):
            other = _relative(change, v, rest)
            still, before = _stands_still(other, before, eps), other
        if _all(still):
            break
        last = size
    settled = size <= UNSETTLED
    if h is not None and not _all(settled):
        settled = settled | (_square(change, spin) ** 0.5 * _lanes(h) <= eps**0.5)
    return v if _all(settled) else np.where(np.asarray(settled)[..., None], v, np.nan)


def _others(spin: slice, n: int) -> slice | None:
    start, stop, _ = spin.indices(n)
    return None if stop - start == n else slice(0, start) if start else slice(stop, n)


def _relative(change: Array, v: Array, part: slice) -> Any:
    return (_square(change, part) / (_square(v, part) + 1e-300)) ** 0.5


def _stands_still(size: Any, last: Any, eps: float) -> Any:
    """Whether changes of this size are rounding, `last` being the one before.

    Among rounding a change need not shrink each time; above it, slow is not yet settled.
    """
    shrinks = size < last * (1 - 0.5 * (size <= eps**0.5))
    return (size <= eps) | (shrinks ^ True)


def _square(vector: Array, spin: slice) -> Any:
    """``|v|²`` of the velocities that are judged: a float of one vector, quicker to compare."""
    if vector.ndim == 1:
        part = vector[spin]
        return float(part @ part)
    part = vector[..., spin]
    return np.add.reduce(part * part, -1)


def _lanes(h: float | Array) -> Any:
    """The size of a step, (...); steps of lanes have an axis more."""
    return abs(h[..., 0]) if isinstance(h, np.ndarray) and h.ndim else abs(h)


@cache
def _eps(dtype: Any) -> float:
    return float(np.finfo(dtype).eps)


def _all(holds: Any) -> bool:
    return holds if type(holds) is bool else bool(np.all(holds))
