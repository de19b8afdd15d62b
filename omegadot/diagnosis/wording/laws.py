"""What makes the number that acts out of the one that was requested, over several scenarios."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import permutations, product

import numpy as np

from omegadot.diagnosis.wording.digits import factor, number, vector
from omegadot.diagnosis.wording.features import Features
from omegadot.reference_impl.system import Array, System

SAME = 1e-6  # relative; what fits a run of vanishing steps is no better known
CLEAN = 1e-5  # of a power law, in the logarithm
LEAST_POINTS, LEAST_SPAN = 3, 1.0  # on which it rests; of its logarithms


def _close(one: Array, other: Array, size: Array) -> bool:
    return bool(np.all(np.abs(one - other) <= SAME * size))


def law_of(pairs: Sequence[tuple[Array, Array]], what: str, unit: str) -> str:
    """The law by which all pairs (requested, acting), each (k,), go together; "" without any.

    It is a limit, or an addition or a factor that is the same everywhere.
    """
    requested, acting = (np.stack(values) for values in zip(*pairs, strict=True))
    size = np.max(np.maximum(np.abs(requested), np.abs(acting)), axis=-1, keepdims=True)
    size = np.where(size > 0.0, size, 1.0)
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
    k = float(np.sum(acting * requested / size**2) / np.sum((requested / size) ** 2))
    if _close(k * requested, acting, size):
        return f"{what} is scaled by {factor(k)}"
    if not few:
        order = _order(requested, acting, size)
        if order:
            return f"{what} has other axes: x, y, z hold {order} of what was requested"
    if few and np.all(_close(acting, acting[0], size)):
        return f"{what} is {number(float(acting[0, 0]))} {unit}, whatever was requested"
    return ""


def _order(requested: Array, acting: Array, size: Array) -> str:
    """The one order of axes, with signs, that makes all pairs; "" where none or several do."""
    found = [
        (order, signs)
        for order in permutations(range(3))
        for signs in product((1.0, -1.0), repeat=3)
        if _close(np.array(signs) * requested[:, list(order)], acting, size)
    ]
    if len(found) != 1:
        return ""
    pairs = zip(*found[0], strict=True)
    return ", ".join(f"{'-' if sign < 0 else ''}{'xyz'[axis]}" for axis, sign in pairs)


def power_law(what: str) -> Callable[[Sequence[tuple[Features, System, Array]]], str]:
    """A factor that goes as a power of one size of the scenarios, as text; "" without any."""

    def law(known: Sequence[tuple[Features, System, Array]]) -> str:
        if len(known) < LEAST_POINTS:
            return ""
        k = np.array([float(p[0]) for _, _, p in known])
        if np.any(k * k[0] <= 0.0):
            return ""
        for name, (_, unit) in known[0][0].sizes.items():
            x = np.array([features.sizes[name][0] for features, _, _ in known])
            if np.any(x <= 0.0) or np.ptp(np.log(x)) < LEAST_SPAN:
                continue
            slope, start = np.polyfit(np.log(x), np.log(np.abs(k)), 1)
            left = np.log(np.abs(k)) - slope * np.log(x) - start
            if np.max(np.abs(left)) > CLEAN or abs(slope) < CLEAN:
                continue
            if what in name and abs(slope + 1.0) < CLEAN:
                size = float(np.sign(k[0]) * np.exp(start))
                return f"{name} is {number(size)} {unit}, whatever was requested"
            return f"{what} is scaled by a factor that goes as {name}^{number(round(slope, 4))}"
        return ""

    return law
