"""A phase that grows for a million periods and is still good to the last digit."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal

import numpy as np

from omegadot.reference_impl.closed_forms.digits import TWO, cos_sin, many_digits, pi
from omegadot.reference_impl.system import Array

_SPLITTER = 2.0**27 + 1.0
_ARCS = 1024


@dataclass(frozen=True)
class Times:
    """Times (n,) s and their leading and trailing 26 bits."""

    value: Array
    high: Array
    low: Array

    @classmethod
    def of(cls, value: Array) -> Times:
        """Split without error (T. J. Dekker, Numer. Math. 18 (1971) 224-242, section 5)."""
        scaled = _SPLITTER * value
        high = scaled - value
        np.subtract(scaled, high, out=high)
        return cls(value, high, value - high)


@dataclass(frozen=True)
class Phase:
    """``x(t) = rate t + start`` in turns.

    rate: three parts of 26, 27 and 53 bits; start: two of 53.  The leading product with the leading
    bits of t is exact and is reduced before anything is added to it, so the error of x modulo
    1 is a rounding error of that remainder and ``|x| 2^-79``.
    """

    rate: tuple[float, float]
    start: tuple[float, float]

    @classmethod
    def of(cls, rate: Decimal, start: Decimal) -> Phase:
        """From constants of many digits."""
        leading = float(rate)
        scaled = _SPLITTER * leading
        leading = scaled - (scaled - leading)
        high = float(start)
        return cls((leading, float(rate - Decimal(leading))), (high, float(start - Decimal(high))))

    def at(self, times: Times) -> Array:
        """x, not reduced."""
        small = times.low * self.rate[0]
        small += times.value * self.rate[1]
        small += self.start[1]
        product = times.high * self.rate[0]
        product += self.start[0]
        product += small
        return product

    def modulo(self, times: Times) -> Array:
        """X less some whole number, small: for uses that have the period one anyhow."""
        product = times.high * self.rate[0]
        product -= np.rint(product)
        small = times.low * self.rate[0]
        small += times.value * self.rate[1]
        if self.start[0]:
            product += self.start[0]
            small += self.start[1]
        product += small
        return product

    def reduced(self, times: Times) -> tuple[Array, Array]:
        """``(n, r)`` with ``x = n + r`` up to an even number, n whole and |r| <= 1/2."""
        small = times.low * self.rate[0]
        small += times.value * self.rate[1]
        small += self.start[1]
        product = times.high * self.rate[0]
        whole = 0.5 * product
        np.rint(whole, out=whole)
        whole += whole
        product -= whole
        np.add(product, self.start[0], out=whole)
        whole += small
        np.rint(whole, out=whole)
        product -= whole
        product += self.start[0]
        product += small
        return whole, product


def _arcs() -> Array:
    """``exp(2πi k / 1024)`` for k from -512 to 511, each part rounded once."""
    with many_digits():
        octant = [cos_sin(TWO * pi() * k / _ARCS) for k in range(_ARCS // 8 + 1)]
    eighth = np.array([complex(float(c), float(s)) for c, s in octant])
    quarter = np.concatenate([eighth, (1j * eighth.conj())[-2::-1]])
    half = np.concatenate([quarter, (-quarter.conj())[-2::-1]])
    return np.concatenate([half.conj()[:0:-1], half[:-1]])


_TABLE = _arcs()
_TURN = 2 * np.pi


def unit_circle(turns: Array) -> Array:
    """``exp(2πi turns)``, complex, (n,) turns of moderate size.

    The nearest of 1024 tabulated points, turned by the small angle that is left: three times as
    fast as a cosine and a sine, and without their rounding of 2π turns.
    """
    scaled = _ARCS * turns
    nearest = np.rint(scaled)
    scaled -= nearest
    scaled *= _TURN / _ARCS
    square = scaled * scaled
    rest = np.empty(turns.shape, complex)
    cosine = square * (1 / 24)
    cosine -= 0.5
    np.multiply(cosine, square, out=rest.real)
    square *= square * (1 / 120) - 1 / 6
    square *= scaled
    np.add(square, scaled, out=rest.imag)
    index = nearest.astype(np.int64)
    index += _ARCS // 2
    points = _TABLE.take(index, mode="wrap")
    rest *= points
    rest += points
    return rest
