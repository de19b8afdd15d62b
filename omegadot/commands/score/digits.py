"""The resolution of a printed number: half a unit of the last one.

Two ways of printing are common: so many decimals, or so many significant digits. A column is
taken for the coarser of what its most decimals and its most significant digits would leave, which
is right for both: with fixed decimals the largest numbers have the most digits, with fixed digits
the smallest have the most decimals. Trailing zeros that were dropped do not disturb it.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from math import gcd

import numpy as np

from omegadot.gates.bounds.scales import EPS
from omegadot.reference_impl.system import Array

# Enough to have met the longest number of a column, few enough to look at one by one.
MOST_LOOKED_AT = 4000
# A double has this many digits, enough to identify it: it was printed whole.
ALL_DIGITS = 16
SINGLE_DIGITS = 9
NUMBER = r"^[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eEdD][+-]?[0-9]+)?$"
NOT_FINITE = re.compile(r"[+-]?(nan|inf|infinity|1\.#\w+|na|null|none)$", re.IGNORECASE)
DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+([eEdD][+-]?\d+)?$")
_NUMBER = re.compile(r"[+-]?(\d*)\.?(\d*)(?:[eEdD]([+-]?\d+))?$")


def digits_of(text: str) -> tuple[int, int]:
    """(decimals, significant digits) of a printed number; (0, 0) of none."""
    found = _NUMBER.match(text.strip())
    if not found:
        return 0, 0
    whole, part, exponent = found.group(1), found.group(2), int(found.group(3) or 0)
    return len(part) - exponent, len((whole + part).lstrip("0"))


def is_single(cells: Sequence[str], values: Array) -> bool:
    """Whether numbers of single precision were written with the digits of a double."""
    with np.errstate(over="ignore"):
        single = values.astype(np.float32).astype(float)
    return bool(np.all(single == values)) and longest(cells)[1] > SINGLE_DIGITS


def printed_whole(cells: Sequence[str]) -> bool:
    """Whether all digits of a double were written: so many, some of them decimals."""
    decimals, significant = longest(cells)
    return decimals > 0 and significant >= ALL_DIGITS


def longest(cells: Sequence[str]) -> tuple[int, int]:
    """The most decimals, and the most significant digits, of a column."""
    step = max(1, len(cells) // MOST_LOOKED_AT)
    known = [digits_of(text) for text in {*cells[::step], cells[-1]}]
    return max(d for d, _ in known), max(s for _, s in known)


def open_of(cells: Sequence[str], values: Array, known: tuple[int, int] | None = None) -> Array:
    """(n,): half a unit of the last digit, a double's own rounding at least.

    known: the decimals and significant digits, where they are not those of the cells alone.
    A column that is zero throughout is taken as exact, and so is zero in one printed whole. A
    double that single precision holds was computed in that, and is open by its rounding.
    """
    own: Array = 0.5 * EPS * np.abs(values)
    decimals, significant = known or longest(cells)
    if is_single(cells, values):
        return np.asarray(0.5 * np.abs(np.spacing(values.astype(np.float32))), dtype=float)
    if not np.any(values) or significant >= ALL_DIGITS:
        return own
    with np.errstate(divide="ignore"):
        place = np.floor(np.log10(np.abs(values)))
    place = np.where(np.isfinite(place), place, -np.inf)
    last = np.maximum(10.0 ** (place - significant + 1), 10.0 ** float(-min(decimals, 300)))
    return np.asarray(np.maximum(own, 0.5 * last))


def trimmed(cells: Sequence[str]) -> bool:
    """Whether the zeros at the ends of decimals were dropped: none stands there, but in ``1.0``."""
    step = max(1, len(cells) // MOST_LOOKED_AT)
    decimals = {text.strip().partition(".")[2] for text in cells[::step]}
    return len({len(d) for d in decimals}) > 1 and not any(
        d.endswith("0") and d != "0" for d in decimals
    )


def shared_digits(columns: Sequence[Sequence[str]], values: Sequence[Array]) -> tuple[int, int]:
    """The most decimals and significant digits of several columns: how their writer prints.

    A column that never changes shows few of them where zeros are dropped at the end of decimals.
    """
    known = [
        longest(cells)
        for cells, own in zip(columns, values, strict=True)
        if not np.all(own == own[0]) and trimmed(cells)
    ]
    return max((d for d, _ in known), default=0), max((s for _, s in known), default=0)


def open_time(cells: Sequence[str], values: Array) -> Array:
    """(n,): the same for time stamps, which are often whole multiples of a coarser unit.

    Stamps that all lie on a grid coarser than their last digit were not rounded to that digit.
    """
    decimals, significant = longest(cells)
    whole_double = significant >= ALL_DIGITS and decimals > 0
    if len(values) > 1 and 0 <= decimals < 18 and not whole_double:
        ticks = np.round(values * 10.0**decimals)
        if np.max(np.abs(ticks)) < 2.0**53:
            gaps = np.diff(ticks).astype(np.int64)
            whole = [int(gap) for gap in np.unique(gaps)]
            if len(whole) == 1 or gcd(*whole) > 1:
                return np.asarray(0.5 * EPS * np.abs(values))
    return open_of(cells, values)
