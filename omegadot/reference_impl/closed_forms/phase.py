"""A phase that grows for a million periods and is still good to the last digit.

Its points of the unit circle are a table of arcs, and a short turn from the nearest one.
"""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal

import numpy as np

from omegadot.reference_impl.arithmetic.double_words import SPLITTER
from omegadot.reference_impl.closed_forms.digits import TWO, cos_sin, fewer_digits, pi
from omegadot.reference_impl.closed_forms.times import Grid, Times
from omegadot.reference_impl.system import Array

ARCS = 4096  # to a turn; half of one to the fifth power, over 5!, is below eps/100
_STRIDE = 32


def _arcs() -> Array:
    """``exp(2πi k / 4096)`` for k from 0 to 4095, each part rounded once.

    An eighth of the circle, as products of points 32 arcs apart and of the first 32 ones.
    """
    with fewer_digits():
        step = TWO * pi() / ARCS
        fine = [cos_sin(step * k) for k in range(_STRIDE)]
        coarse = [cos_sin(step * k) for k in range(0, ARCS // 8 + 1, _STRIDE)]
        octant = [_turned(a, b) for a in coarse for b in fine][: ARCS // 8 + 1]
    eighth = np.array([complex(float(c), float(s)) for c, s in octant])
    quarter = np.concatenate([eighth, (1j * eighth.conj())[-2::-1]])
    half = np.concatenate([quarter, (-quarter.conj())[-2::-1]])
    return np.concatenate([half[:-1], -half[:-1]])


def _turned(a: tuple[Decimal, Decimal], b: tuple[Decimal, Decimal]) -> tuple[Decimal, Decimal]:
    return a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]


_TABLE = _arcs()
_ARC = 2 * np.pi / ARCS


def unit_circle(turns: Array) -> Array:
    """``exp(2πi turns)``, complex, (n,) turns of moderate size."""
    scaled = ARCS * turns
    nearest = np.rint(scaled)
    scaled -= nearest
    return unit_circle_at(nearest, scaled)


def unit_circle_at(nearest: Array, rest: Array, start: int = 0) -> Array:
    """``exp(2πi (start + nearest + rest) / 4096)``, complex; nearest whole, |rest| about 1/2.

    The tabulated point, turned by the small angle that is left: three times as fast as a cosine
    and a sine, and without their rounding of 2π turns. The arrays given are used up.
    """
    index = nearest.astype(np.int64)
    if start:
        index += start
    index &= ARCS - 1
    rest *= _ARC
    square = np.multiply(rest, rest, out=nearest)
    turned = np.empty(rest.shape, complex)
    part = square * (1 / 24)
    part -= 0.5
    np.multiply(part, square, out=turned.real)
    square *= -1 / 6
    square *= rest
    np.add(square, rest, out=turned.imag)
    points = _TABLE.take(index, mode="wrap")
    turned *= points
    turned += points
    return turned


_SHORT = 1e-9  # turns: the square of what is left out, (2π 1e-9)²/2, is below eps/8


@dataclass(frozen=True, eq=False)
class Phase:
    """``x(t) = rate t + start`` in turns.

    rate: three parts of 26, 27 and 53 bits; start: two of 53.  arc: the start in whole arcs and
    what is left of an arc.  The leading product with the leading bits of t is exact and is reduced
    before anything is added to it, so the error of x modulo 1 is a rounding error of that
    remainder and ``|x| 2^-79``.
    """

    rate: tuple[float, float]
    start: tuple[float, float]
    arc: tuple[int, float]

    @classmethod
    def of(cls, rate: Decimal, start: Decimal) -> Phase:
        """From constants of many digits."""
        leading = float(rate)
        scaled = SPLITTER * leading
        leading = scaled - (scaled - leading)
        high = float(start)
        whole = round(start * ARCS)
        return cls(
            (leading, float(rate - Decimal(leading))),
            (high, float(start - Decimal(high))),
            (whole % ARCS, float(start * ARCS - whole)),
        )

    def at(self, times: Times) -> Array:
        """x, not reduced."""
        small = self._lower(times)
        small += self.start[1]
        product = times.halves[0] * self.rate[0]
        product += self.start[0]
        product += small
        return product

    def _lower(self, times: Times, scale: float = 1.0) -> Array:
        """``scale rate t`` but for its leading product; scale: a power of two."""
        small = times.halves[1] * (scale * self.rate[0])
        small += times.value * (scale * self.rate[1])
        return small

    def circle(self, times: Times, more: Array | None = None) -> Array:
        """``exp(2πi x)``, complex (n,); more: a phase in turns that is added to x."""
        if more is None and times.grid is not None:
            return self._on_grid(times, times.grid)
        return self._circle(times, more, self.arc)

    def _circle(self, times: Times, more: Array | None, start: tuple[int, float]) -> Array:
        small = self._lower(times, ARCS)
        if more is not None:
            small += ARCS * more
        if start[1]:
            small += start[1]
        product = times.halves[0] * (ARCS * self.rate[0])
        nearest = product + small
        np.rint(nearest, out=nearest)
        product -= nearest  # exact: both are multiples of the product's last bit
        product += small
        return unit_circle_at(nearest, product, start[0])

    def _on_grid(self, times: Times, grid: Grid) -> Array:
        """``exp(2πi x(b)) exp(2πi rate o)``, turned by the little that t is off ``b + o``."""
        if grid.spread * abs(self.rate[0]) > _SHORT:
            return self._circle(times, None, self.arc)
        rows, columns = grid.kept.get(self, (None, None))
        if rows is None or columns is None:
            rows = self._circle(grid.rows, None, self.arc)[:, None]
            columns = self._circle(grid.columns, None, (0, 0.0))
            grid.kept[self] = rows, columns
        circle: Array = rows[grid.part] * columns
        turned = np.ones(circle.shape, complex)
        np.multiply(grid.off, 2 * np.pi * self.rate[0], out=turned.imag)
        circle *= turned
        return circle.reshape(-1)

    def reduced(self, times: Times) -> tuple[Array, Array]:
        """``(n, r)`` with ``x = n + r``, n whole and |r| <= 1/2."""
        small = self._lower(times)
        small += self.start[1]
        product = times.halves[0] * self.rate[0]
        whole = product + self.start[0]
        whole += small
        np.rint(whole, out=whole)
        product -= whole
        product += self.start[0]
        product += small
        return whole, product
