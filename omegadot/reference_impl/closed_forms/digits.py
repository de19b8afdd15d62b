"""Constants to eighty digits, and to thirty-two once nothing can cancel any more.

A closed form has few constants and many times. The constants (moduli, periods, rates, phases) are
worked out in decimal arithmetic from the inputs taken as exact, so that nothing in them cancels
down to double precision; above all the difference of products that decides on which side of the
separatrix a body lies. Only the motion in time runs in double precision.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import AbstractContextManager
from decimal import (
    MAX_EMAX,
    MIN_EMIN,
    Context,
    Decimal,
    DivisionByZero,
    InvalidOperation,
    Overflow,
    getcontext,
    localcontext,
)
from functools import cache
from math import isqrt
from typing import TypeAlias

import numpy as np

from omegadot.reference_impl.system import Array

PRECISION = 80
_FEWER = 32  # a phase that is good to a double's digits after 1e6 turns needs 23
ZERO, ONE, TWO, HALF = Decimal(0), Decimal(1), Decimal(2), Decimal("0.5")
EPSILON = Decimal(2) ** -52  # of double precision
INFINITY = Decimal("Infinity")
RESOLUTION = Decimal(10) ** (5 - PRECISION)  # relative size of what rounding may leave of a zero

Row: TypeAlias = list[Decimal]
Matrix: TypeAlias = list[Row]

_CONTEXT = Context(
    prec=PRECISION,
    Emin=MIN_EMIN,
    Emax=MAX_EMAX,
    traps=[InvalidOperation, DivisionByZero, Overflow],
)


def many_digits() -> AbstractContextManager[Context]:
    """Decimal arithmetic in here has eighty digits and no practical limit of the exponent."""
    return localcontext(_CONTEXT)


def fewer_digits() -> AbstractContextManager[Context]:
    """Thirty-two digits, for what follows without cancellation from amplitudes and moduli."""
    return localcontext(_CONTEXT, prec=_FEWER)


def least(share: int) -> Decimal:
    """``10^(-digits/share)``: what is negligible when it enters with the power ``share``."""
    return ONE.scaleb(-getcontext().prec // share)


def exact(values: Array) -> Row:
    """Doubles as the decimal numbers they are, flattened."""
    return [Decimal(float(value)) for value in np.asarray(values, float).ravel()]


def exact_matrix(values: Array) -> Matrix:
    """A matrix of doubles as the decimal numbers they are."""
    return [exact(row) for row in np.asarray(values, float)]


def doubles(values: Sequence[Decimal]) -> Array:
    """Each number rounded once to double precision."""
    return np.array([float(value) for value in values])


def dot(a: Sequence[Decimal], b: Sequence[Decimal]) -> Decimal:
    """``a · b``."""
    return sum((x * y for x, y in zip(a, b, strict=True)), ZERO)


def cross(a: Sequence[Decimal], b: Sequence[Decimal]) -> Row:
    """``a × b``."""
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]


def apply(matrix: Matrix, vector: Sequence[Decimal]) -> Row:
    """``matrix @ vector``."""
    return [dot(row, vector) for row in matrix]


def power(x: Decimal, n: int) -> Decimal:
    """``x^n`` with ``0^0 = 1``."""
    return x**n if n else ONE


@cache
def pi() -> Decimal:
    """π by the iteration of Gauss, Brent and Salamin: DLMF 19.8(i)."""
    with many_digits():
        a, b, t, x = ONE, HALF.sqrt(), HALF * HALF, ONE
        for _ in range(8):  # correct digits double: 2^8 > 80
            mean = (a + b) / 2
            a, b, t, x = mean, (a * b).sqrt(), t - x * (a - mean) ** 2, 2 * x
        return (a + b) ** 2 / (4 * t)


def cos_sin(x: Decimal) -> tuple[Decimal, Decimal]:
    """``(cos x, sin x)`` by the power series of exp(ix/16), squared four times."""
    y = x / 16
    real, imaginary, term, n = ONE, ZERO, ONE, 0
    negligible = least(1)
    while n < 4 or abs(term) > negligible:
        n += 1
        term = term * y / n
        sign = -1 if n % 4 in (2, 3) else 1
        if n % 2:
            imaginary += sign * term
        else:
            real += sign * term
    for _ in range(4):
        real, imaginary = real * real - imaginary * imaginary, 2 * real * imaginary
    return real, imaginary


def multiples(x: Decimal, count: int) -> list[tuple[Decimal, Decimal]]:
    """``(cos nx, sin nx)`` for n below count, by turning."""
    cosine, sine = cos_sin(x)
    found = [(ONE, ZERO)]
    for _ in range(count - 1):
        c, s = found[-1]
        found.append((c * cosine - s * sine, c * sine + s * cosine))
    return found


def agm(a: Decimal, b: Decimal) -> Decimal:
    """Arithmetic-geometric mean of positive numbers, DLMF 19.8.1; zero where one of them is.

    The mean of a and b is off by ``(a - b)² / 16a`` at most.
    """
    if a == 0 or b == 0:
        return ZERO
    close = least(2)
    while abs(a - b) > close * a:
        a, b = (a + b) * HALF, (a * b).sqrt()
    return (a + b) * HALF


def carlson_rf(x: Decimal, y: Decimal, z: Decimal) -> Decimal:
    """``R_F(x, y, z)`` for non-negative x, y, z, at most one of them zero.

    Duplication, DLMF 19.26.18, until the spread is below an eighth of the digits, then the
    expansion DLMF 19.36.1 in the elementary symmetric functions, whose first omitted terms are of
    its eighth power.
    (Carlson, Numerical computation of real or complex elliptic integrals, Numer. Algorithms 10
    (1995) 13-26, section 2.) The duplication runs in whole numbers, of more than twice the digits
    so that a small argument keeps its own, because their square roots are so much the faster.
    """
    digits = getcontext().prec
    while sorted((x, y, z))[1] < least(2) * max(x, y, z):  # too small for whole numbers, for now
        sx, sy, sz = x.sqrt(), y.sqrt(), z.sqrt()
        added = sx * sy + sy * sz + sz * sx
        x, y, z = (x + added) / 4, (y + added) / 4, (z + added) / 4
    top = max(x, y, z)
    one, rest = 1 << 8 * digits, 10 ** -(-digits // 8)
    a, b, c = (int(value / top * one) for value in (x, y, z))
    while True:
        mean = (a + b + c) // 3
        if max(abs(a - mean), abs(b - mean), abs(c - mean)) * rest < mean:
            break
        sa, sb, sc = isqrt(a * one), isqrt(b * one), isqrt(c * one)
        shift = (sa * sb + sb * sc + sc * sa) // one
        a, b, c = (a + shift) >> 2, (b + shift) >> 2, (c + shift) >> 2
    dx, dy = ONE - Decimal(a) / mean, ONE - Decimal(b) / mean
    dz = -(dx + dy)
    e2, e3 = dx * dy - dz * dz, dx * dy * dz
    series = ONE - e2 / 10 + e3 / 14 + e2 * e2 / 24 - 3 * e2 * e3 / 44
    series += -5 * e2**3 / 208 + 3 * e3**2 / 104 + e2**2 * e3 / 16
    return series / (top * mean / one).sqrt()
