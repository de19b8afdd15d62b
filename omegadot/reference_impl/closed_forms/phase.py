"""A phase that grows for a million periods and is still good to the last digit."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal

import numpy as np

from omegadot.reference_impl.closed_forms.arcs import ARCS, unit_circle_at
from omegadot.reference_impl.closed_forms.times import Grid, Times
from omegadot.reference_impl.double_words import SPLITTER
from omegadot.reference_impl.system import Array

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
        product = times.high * self.rate[0]
        product += self.start[0]
        product += small
        return product

    def _lower(self, times: Times, scale: float = 1.0) -> Array:
        """``scale rate t`` but for its leading product; scale: a power of two."""
        small = times.low * (scale * self.rate[0])
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
        product = times.high * (ARCS * self.rate[0])
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
        product = times.high * self.rate[0]
        whole = product + self.start[0]
        whole += small
        np.rint(whole, out=whole)
        product -= whole
        product += self.start[0]
        product += small
        return whole, product
