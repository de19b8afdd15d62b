"""Times, split without error, and the grid on which evenly spaced ones nearly lie."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from omegadot.reference_impl.arithmetic.double_words import split
from omegadot.reference_impl.system import Array

COLUMNS = 512
_FEWEST = 8  # rows; with fewer of them a grid saves nothing
_EVEN = 2.0**-32  # of the span of a row: others are not worth the trouble
# Of a row's first time: its span, so that no time in it is beyond twice that.
_WITHIN = 1 - 2.0**-10


@dataclass(frozen=True)
class Times:
    """Times (n,) s; where they are evenly spaced, the grid that they make."""

    value: Array
    grid: Grid | None = None

    @cached_property
    def halves(self) -> tuple[Array, Array]:
        """The leading 26 bits, and what they leave, exactly."""
        return split(self.value)


@dataclass(frozen=True)
class Grid:
    """``t = b_r + o_c + off``: a phase needs few points of the circle and their products.

    rows: b, all of them.  columns: o.  part: the rows at hand; value: their times.  kept: what
    each phase has worked out of rows and columns.
    """

    rows: Times
    columns: Times
    part: slice
    value: Array
    kept: dict[object, tuple[Array, Array]] = field(default_factory=dict)

    @cached_property
    def off(self) -> Array:
        """(rows at hand, columns) s, exactly."""
        off: Array = self.value.reshape(-1, COLUMNS) - self.rows.value[self.part, None]
        off -= self.columns.value
        return off

    @cached_property
    def spread(self) -> float:
        """The greatest size of what the times are off."""
        return max(float(self.off.max()), -float(self.off.min()))


def chunks(value: Array, size: int) -> Iterator[tuple[slice, Times]]:
    """The times in parts of the given size, on a grid wherever they are evenly spaced."""
    whole = _grid_of(value)
    for first in range(0, value.size, size):
        part = slice(first, min(first + size, value.size))
        yield part, Times(value[part], _part_of(whole, value, part))


def _grid_of(value: Array) -> Grid | None:
    """The grid of all times that fill rows, or None where these are not even.

    The difference of two doubles is exact where they are within a factor of two of one another
    (P. H. Sterbenz, Floating-Point Computation, 1974, section 4.3), or one of them is zero.
    """
    rows = value[: value.size - value.size % COLUMNS].reshape(-1, COLUMNS)
    if len(rows) < _FEWEST:
        return None
    first, columns = rows[:, 0], rows[0] - rows[0, 0]
    span = rows[:, -1] - first
    near = (first == 0) | (np.abs(span) <= _WITHIN * np.abs(first)) & (first * span > 0)
    even = np.abs(span - span[0]) <= _EVEN * np.abs(span[0])
    inside = np.all(columns * span[0] >= 0) and np.all(np.abs(columns) <= np.abs(span[0]))
    if not (inside and np.all(near & even)):
        return None
    return Grid(Times(first.copy()), Times(columns), slice(0, 0), first[:0])


def _part_of(whole: Grid | None, value: Array, part: slice) -> Grid | None:
    if whole is None or (part.stop - part.start) % COLUMNS:
        return None
    rows = slice(part.start // COLUMNS, part.stop // COLUMNS)
    return replace(whole, part=rows, value=value[part])
