"""What makes the number that acts out of the one that was requested, over several scenarios."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from omegadot.diagnosis.wording.digits import factor, number, vector
from omegadot.reference_impl.system import Array

SAME = 1e-7  # relative; what fits a run of vanishing steps is no better known


def _close(one: Array, other: Array, size: float) -> bool:
    return bool(np.all(np.abs(one - other) <= SAME * size))


def law_of(pairs: Sequence[tuple[Array, Array]], what: str, unit: str) -> str:
    """The law by which all pairs (requested, acting), each (k,), go together; "" without any.

    It is a limit, or an addition or a factor that is the same everywhere.
    """
    requested, acting = (np.stack(values) for values in zip(*pairs, strict=True))
    size = float(np.max(np.abs(requested))) or 1.0
    changed = np.abs(acting - requested) > SAME * np.maximum(np.abs(requested), np.abs(acting))
    if np.count_nonzero(changed.any(axis=-1)) < 2:
        return ""
    few = requested.shape[-1] == 1
    each = what if few else f"each component of {what}"
    held = acting[changed]
    high, low = float(np.max(held)), float(np.min(held))
    if _close(np.minimum(requested, high), acting, size):
        return f"{each} is limited to {number(high)} {unit}"
    if _close(np.maximum(requested, low), acting, size):
        return f"{each} is held above {number(low)} {unit}"
    if not few and _close(np.clip(requested, -high, high), acting, size):
        return f"{each} is limited to {number(high)} {unit} either way"
    lengths, due = (np.linalg.norm(v, axis=-1, keepdims=True) for v in (acting, requested))
    longest = float(np.max(lengths[changed.any(axis=-1)]))
    with np.errstate(divide="ignore", invalid="ignore"):
        scaled = np.where(due > 0.0, requested * np.minimum(1.0, longest / due), 0.0)
    if not few and _close(scaled, acting, size):
        return f"the size of {what} is limited to {number(longest)} {unit}"
    zero = np.abs(requested[changed])
    if not np.any(held) and not np.any((np.abs(requested) <= np.max(zero)) & (acting != 0.0)):
        least = np.abs(requested[acting != 0.0])
        if len(least):
            between = f"{number(float(np.max(zero)))} and {number(float(np.min(least)))}"
            return f"{each} is taken for zero below a limit between {between} {unit}"
    more = acting - requested
    if _close(more, more[0], size):
        shown = number(float(more[0, 0])) if few else vector(more[0])
        return f"{shown} {unit} is added to {what}"
    k = float(np.sum(acting * requested) / np.sum(requested * requested))
    if _close(k * requested, acting, size):
        return f"{what} is scaled by {factor(k)}"
    if few and np.all(_close(acting, acting[0], size)):
        return f"{what} is {number(float(acting[0, 0]))} {unit}, whatever was requested"
    return ""
