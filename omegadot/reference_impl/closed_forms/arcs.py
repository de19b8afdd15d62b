"""Points of the unit circle: a table of arcs, and a short turn from the nearest one."""

from __future__ import annotations

from decimal import Decimal

import numpy as np

from omegadot.reference_impl.closed_forms.digits import TWO, cos_sin, fewer_digits, pi
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
