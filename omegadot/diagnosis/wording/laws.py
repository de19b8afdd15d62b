"""What makes the number that acts out of the one that was requested, over several scenarios."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, permutations, product

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.wording.digits import factor, limits, number, vector
from omegadot.diagnosis.wording.features import Features
from omegadot.diagnosis.wording.kinds import NUMBER
from omegadot.reference_impl.system import Array

SAME = 1e-6  # relative; what fits a run of vanishing steps is no better known
NOTHING = 1e-12  # of a vector, in one of its components
CLEAN = 1e-5  # relative: a factor that is one
LOOSE = 1e-2  # of a power law, in the logarithm, before it is tried
MOST_DECIMALS = 9
MOST_BITS, MOST_DIGITS = 18, 6  # of more a fitted number shows nothing
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
    acting = np.where(np.abs(acting) <= NOTHING * size, 0.0, acting)  # rounding of nothing
    changed = np.abs(acting - requested) > SAME * np.maximum(np.abs(requested), np.abs(acting))
    changed &= np.abs(acting - requested) > NOTHING * size  # rounding of what is nothing
    if np.count_nonzero(changed.any(axis=-1)) < 2:
        return ""
    if np.ptp(np.abs(requested[changed])) > SAME * np.max(np.abs(requested[changed])):
        text = _limit(_Pairs(requested, acting, changed, size, what, unit))
        if text:
            return text
    return _other_law(_Pairs(requested, acting, changed, size, what, unit))


@dataclass(frozen=True)
class _Pairs:
    """Numbers (n, k) that were requested and that act; changed: which are others.

    size: (n, 1), of each.
    """

    requested: Array
    acting: Array
    changed: NDArray[np.bool_]
    size: Array
    what: str
    unit: str

    @property
    def few(self) -> bool:
        """Whether each is one number."""
        return bool(self.requested.shape[-1] == 1)

    @property
    def each(self) -> str:
        """What one of the numbers is."""
        return self.what if self.few else f"each component of {self.what}"

    @property
    def lengths(self) -> tuple[Array, Array]:
        """(n, 1) each: of what acts, and of what was requested."""
        acting, due = (
            np.linalg.norm(v, axis=-1, keepdims=True) for v in (self.acting, self.requested)
        )
        return acting, due


def _limit(pairs: _Pairs) -> str:
    """Of each number or of the size: several that were requested come to one."""
    requested, acting, changed, size = pairs.requested, pairs.acting, pairs.changed, pairs.size
    what, unit, few, each = pairs.what, pairs.unit, pairs.few, pairs.each
    # the limit is known best where what was requested is least
    place = int(np.argmin(np.where(changed, np.abs(requested), np.inf)))
    limit = float(acting.flat[place])
    if _close(np.minimum(requested, limit), acting, size):
        return f"{each} is limited to {number(limit)} {unit}"
    if _close(np.maximum(requested, limit), acting, size):
        return f"{each} is held above {number(limit)} {unit}"
    most = abs(limit)
    if not few and most > 0.0 and _close(np.clip(requested, -most, most), acting, size):
        return f"{each} is limited to {number(most)} {unit} either way"
    lengths, due = pairs.lengths
    whole = changed.any(axis=-1)
    longest = float(lengths[whole][np.argmin(due[whole]), 0])
    with np.errstate(divide="ignore", invalid="ignore"):
        scaled = np.where(due > 0.0, requested * np.minimum(1.0, longest / due), 0.0)
    if not few and longest > 0.0 and _close(scaled, acting, size):
        return f"the size of {what} is limited to {number(longest)} {unit}"
    return ""


def _other_law(pairs: _Pairs) -> str:
    """Rounding, a least size, an addition, a factor, other axes or one number."""
    requested, acting, changed, size = pairs.requested, pairs.acting, pairs.changed, pairs.size
    what, unit, few, each = pairs.what, pairs.unit, pairs.few, pairs.each
    held = acting[changed]
    lengths, due = pairs.lengths
    for digits in range(MOST_DECIMALS):
        rounded = np.round(requested, digits)
        if _close(rounded, acting, size) and np.max(np.abs(held)) >= 0.5 * 10.0**-digits:
            return f"{what} is rounded to {digits} decimals"
    if np.count_nonzero(changed.any(axis=-1)) >= LEAST_POINTS:
        for way, rounded in _coarser(requested):
            if _close(rounded, acting, size):
                return f"{what} is rounded to {way}"
    zero = np.abs(requested[changed])
    if not np.any(held) and not np.any((np.abs(requested) <= np.max(zero)) & (acting != 0.0)):
        least = np.abs(requested[acting != 0.0])
        if len(least):
            between = limits(float(np.max(zero)), float(np.min(least)), unit)
            return f"{each} is taken for zero below a limit between {between}"
    gone = (lengths == 0.0) & changed.any(axis=-1, keepdims=True)
    if not few and np.any(lengths) and not np.any(changed & ~gone):
        low, high = float(np.max(due[gone], initial=0.0)), float(np.min(due[lengths > 0.0]))
        if 0.0 < low < high:
            between = limits(low, high, unit)
            return f"{what} is taken for zero where its size is below a limit between {between}"
    more = acting - requested
    if _close(more, more[0], size):
        shown = number(float(more[0, 0])) if few else vector(more[0])
        return f"{shown} {unit} is added to {what}"
    k = float(np.sum(acting * requested / size**2) / np.sum((requested / size) ** 2))
    if abs(k - 1.0) > SAME and _close(k * requested, acting, size):
        return f"{what} is scaled by {factor(k)}"
    if not few:
        order = _order(requested, acting, size)
        if order:
            return f"{what} has other axes: x, y, z hold {order} of what was requested"
    if few and np.all(_close(acting, acting[0], size)):
        return f"{what} is {number(float(acting[0, 0]))} {unit}, whatever was requested"
    return ""


def _coarser(requested: Array) -> Iterator[tuple[str, Array]]:
    """Numbers of fewer digits, and what they make of those that were requested."""
    with np.errstate(over="ignore"):
        yield "half precision", requested.astype(np.float16).astype(float)
    part, power = np.frexp(requested)
    for bits in range(2, MOST_BITS):
        yield f"{bits} binary digits", np.ldexp(np.round(np.ldexp(part, bits)), power - bits)
    size = np.abs(requested)
    places = np.floor(np.log10(np.where(size > 0.0, size, 1.0)))
    for digits in range(1, MOST_DIGITS):
        unit = 10.0 ** (places - digits + 1)
        yield f"{digits} digits", np.round(requested / unit) * unit


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


def power_laws(
    text: str, scenarios: Sequence[Features], numbers: Array
) -> Iterator[tuple[str, Array]]:
    """A cause with one number, (n,) on so many scenarios, as powers of one or two of their sizes.

    Yields texts with the numbers that they come to, which have to be tried.
    """
    if len(numbers) < LEAST_POINTS or np.any(numbers * numbers[0] <= 0.0):
        return
    logs = dict[str, Array]()
    for name in scenarios[0].sizes:
        x = np.array([one.sizes[name][0] for one in scenarios])
        if np.all(x > 0.0) and np.ptp(np.log(x)) >= LEAST_SPAN:
            logs[name] = np.log(x)
    wanted = np.log(np.abs(numbers))
    pairs = combinations(logs, 2) if len(numbers) > LEAST_POINTS + 1 else ()
    for names in (*((one,) for one in logs), *pairs):
        lines = np.stack([*(logs[name] for name in names), np.ones(len(numbers))], axis=-1)
        found = np.linalg.lstsq(lines, wanted, rcond=None)[0]
        powers = np.round(2.0 * found[:-1]) / 2.0
        rest = wanted - lines[:, :-1] @ powers
        if not np.all(powers) or np.median(np.abs(rest - np.median(rest))) > LOOSE:
            continue
        size = float(np.sign(numbers[0]) * np.exp(np.median(rest)))
        if abs(abs(size) - 1.0) < CLEAN:
            size = float(np.sign(size))
        units = [scenarios[0].sizes[name][1] for name in names]
        sizes = list(zip(names, units, powers.tolist(), strict=True))
        yield _worded(text, sizes, size), size * np.exp(lines[:, :-1] @ powers)


def _worded(text: str, sizes: Sequence[tuple[str, str, float]], size: float) -> str:
    what, scaled, _ = text.partition(" is scaled by ")
    times = "" if abs(size - 1.0) < CLEAN else f"{number(float(f'{size:.6g}'))} times "
    name, unit, power = sizes[0]
    if len(sizes) == 1:
        if scaled and name.endswith(what) and power == -1.0:
            return f"{name} is {number(size)} {unit}, whatever was requested"
        if scaled and power == -1.0 and times:
            return f"{what} is scaled so that {name} comes to {number(size)} {unit}"
        if scaled and not times and abs(power) == 1.0:
            return f"{what} is {'multiplied' if power > 0 else 'divided'} by {name}"
    above = [_power(n, p) for n, _, p in sizes if p > 0.0]
    below = [_power(n, -p) for n, _, p in sizes if p < 0.0]
    shown = f"{times}{' times '.join(above) or '1'}"
    shown = " over ".join([shown.replace(" times 1", ""), *below])
    if scaled:
        return f"{what} is scaled by a factor that goes as {shown}"
    first = NUMBER.search(text)  # a rate of decay is stated with its sign
    c = "-c" if first is not None and first[0].startswith("-") and size > 0.0 else "c"
    return f"{NUMBER.sub(c, text, count=1)}, where c is {shown}"


def _power(name: str, power: float) -> str:
    return name if power == 1.0 else f"{name}^{number(power)}"
