"""Theta series as polynomials, for the two frames of a clock.

``Σ a_n cos 2nz`` and its kin are polynomials in ``sin² z``; their counterparts with the
complementary nome are polynomials in the two decaying exponentials. The coefficients are worked
out with many digits and rounded once.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from typing import TypeAlias

import numpy as np

from omegadot.reference_impl.closed_forms.digits import ONE, ZERO, Row, power
from omegadot.reference_impl.closed_forms.elliptic import (
    CircularFrame,
    HyperbolicFrame,
    Modulus,
)
from omegadot.reference_impl.system import Array

Frame: TypeAlias = CircularFrame | HyperbolicFrame
Jacobi: TypeAlias = Callable[[Frame], tuple[Array, Array, Array]]

TERMS = 9  # the ninth term of every series here is below 1e-20 of the first
_NEGLIGIBLE = Decimal("1e-18")
_UNFELT = Decimal("1e-30")  # of the largest term; the polynomials' own coefficients stay below 1e6


@dataclass(frozen=True)
class Polynomial:
    """``Σ c_k x^k``, evaluated by Horner's rule."""

    coefficients: tuple[float, ...]

    @classmethod
    def of(cls, coefficients: Sequence[Decimal]) -> Polynomial:
        """Rounded to double; trailing terms that no double can feel are left out."""
        kept = list(coefficients)
        size = max(abs(c) for c in kept)
        while len(kept) > 1 and abs(kept[-1]) <= _NEGLIGIBLE * size:
            kept.pop()
        return cls(tuple(float(c) for c in kept))

    def __call__(self, x: Array) -> Array:
        """The value at x, any shape."""
        highest, *lower = reversed(self.coefficients)
        if not lower:
            return np.full_like(x, highest)
        value = highest * x
        value += lower[0]
        for coefficient in lower[1:]:
            value *= x
            value += coefficient
        return value


def jacobi(modulus: Modulus, sn: Decimal, cn: Decimal, dn: Decimal) -> Jacobi:
    """``(sn · sn u, cn · cn u, dn · dn u)``, the factors given, as a function of a clock's frame.

    DLMF 22.2.4-22.2.6 with the series 20.2.1-20.2.4; near the separatrix after Jacobi's imaginary
    transformation, DLMF 20.7.30-20.7.33.
    """
    return (
        _hyperbolic_jacobi(modulus.complementary_nome, sn, cn, dn)
        if modulus.hyperbolic
        else _circular_jacobi(modulus.nome, sn, cn, dn)
    )


def _circular_jacobi(q: Decimal, sn: Decimal, cn: Decimal, dn: Decimal) -> Jacobi:
    alternate = [(-1) ** n * ONE for n in range(TERMS)]
    odd = [power(q, n * n + n) for n in range(TERMS)]
    even = [ONE] + [2 * power(q, n * n) for n in range(1, TERMS)]
    odd1 = [a * s for a, s in zip(odd, alternate, strict=True)]
    even4 = [a * s for a, s in zip(even, alternate, strict=True)]
    theta2, theta3, theta4 = sum(odd, ZERO), sum(even, ZERO), sum(even4, ZERO)
    denominator = _scaled(cosines(even4), 1 / theta4)
    poly_sn = _scaled(odd_sines(odd1), sn * theta3 / (theta2 * theta4))
    poly_cn = _scaled(odd_cosines(odd), cn / theta2)
    poly_dn = _scaled(cosines(even), dn / theta3)

    def evaluate(frame: Frame) -> tuple[Array, Array, Array]:
        assert isinstance(frame, CircularFrame)
        y = frame.square
        divisor = denominator(y)
        values = poly_sn(y), poly_cn(y), poly_dn(y)
        for value in values:
            value /= divisor
        np.multiply(values[0], frame.sine, out=values[0])
        np.multiply(values[1], frame.cosine, out=values[1])
        return values

    return evaluate


def _hyperbolic_jacobi(q: Decimal, sn: Decimal, cn: Decimal, dn: Decimal) -> Jacobi:
    """With a = near², g = far²: every power of q is shared out so that no exponential grows."""
    square = [power(q, n * n) for n in range(TERMS)]
    oblong = [power(q, n * n + n) for n in range(TERMS)]
    shorter = [ZERO] + [power(q, n * n - n) for n in range(1, TERMS)]
    sign = [(-1) ** n * ONE for n in range(TERMS)]
    theta2 = sum(oblong, ZERO)
    theta3 = ONE + 2 * sum(square[1:], ZERO)
    theta4 = ONE + 2 * sum((s * a for s, a in zip(sign[1:], square[1:], strict=True)), ZERO)
    sn, cn, dn = sn * theta3 / theta4, 2 * cn * theta2 / theta4, 2 * dn * theta2 / theta3

    def pair(far: Row, near: Row, factor: Decimal) -> tuple[Polynomial, Polynomial]:
        return _scaled(far, factor), _scaled(near, factor)

    signed = [[s * x for s, x in zip(sign, row, strict=True)] for row in (square, oblong, shorter)]
    far0, near0 = pair(square, [ZERO, *oblong], ONE)
    far1, near1 = pair(signed[0], [ZERO, *[-x for x in signed[1]]], sn)
    far2, near2 = pair(signed[2], [ONE, *signed[0][1:]], cn)
    far3, near3 = pair(shorter, square, dn)

    def evaluate(frame: Frame) -> tuple[Array, Array, Array]:
        assert isinstance(frame, HyperbolicFrame)
        a, g = frame.near * frame.near, frame.far * frame.far
        divisor = far0(g)
        divisor += near0(a)
        values = far1(g), far2(g), far3(g)
        for value, near in zip(values, (near1(a), near2(a), near3(a)), strict=True):
            value += near
            value /= divisor
        sides = frame.side * frame.sign
        small = frame.near * frame.sign
        np.multiply(values[0], sides, out=values[0])
        np.multiply(values[1], small, out=values[1])
        np.multiply(values[2], frame.near, out=values[2])
        return values

    return evaluate


def _scaled(coefficients: Sequence[Decimal], factor: Decimal) -> Polynomial:
    return Polynomial.of([factor * c for c in coefficients])


def cosines(a: Sequence[Decimal]) -> Row:
    """``Σ a_n cos 2nz`` as a polynomial in ``y = sin² z``."""
    return _combine(a, _first_kind(len(a)))


def sines(a: Sequence[Decimal]) -> Row:
    """``Σ a_n sin 2nz / (sin z cos z)`` as a polynomial in y; a_0 does not matter."""
    u = _second_kind(len(a))
    return [2 * c for c in _combine(a[1:], u)] if len(a) > 1 else [ZERO]


def odd_sines(a: Sequence[Decimal]) -> Row:
    """``Σ a_n sin (2n+1)z / sin z`` as a polynomial in y."""
    return _combine(a, _neighbours(len(a), ONE))


def odd_cosines(a: Sequence[Decimal]) -> Row:
    """``Σ a_n cos (2n+1)z / cos z`` as a polynomial in y."""
    return _combine(a, _neighbours(len(a), -ONE))


# Whole numbers that only depend on how many are wanted: formed once.
@cache
def _first_kind(count: int) -> list[Row]:
    return _chebyshev(count, first=(ONE, [ONE, Decimal(-2)]))


@cache
def _neighbours(count: int, sign: Decimal) -> list[Row]:
    u = _second_kind(count)
    return [u[0]] + [_add(u[n], u[n - 1], sign) for n in range(1, count)]


@cache
def _second_kind(count: int) -> list[Row]:
    return _chebyshev(count, first=(ONE, [Decimal(2), Decimal(-4)]))


def _chebyshev(count: int, first: tuple[Decimal, Row]) -> list[Row]:
    """Chebyshev polynomials of ``cos 2z = 1 - 2y``, as polynomials in y."""
    polynomials = [[first[0]], first[1]]
    while len(polynomials) < count:
        last = polynomials[-1]
        doubled = _add([2 * c for c in last], [ZERO] + [-4 * c for c in last], ONE)
        polynomials.append(_add(doubled, polynomials[-2], -ONE))
    return polynomials[:count]


def _add(p: Row, q: Row, factor: Decimal) -> Row:
    size = max(len(p), len(q))
    p, q = p + [ZERO] * (size - len(p)), q + [ZERO] * (size - len(q))
    return [a + factor * b for a, b in zip(p, q, strict=True)]


def _combine(a: Sequence[Decimal], polynomials: Sequence[Row]) -> Row:
    total, least = [ZERO], _UNFELT * max(map(abs, a), default=ZERO)
    for factor, polynomial in zip(a, polynomials, strict=False):
        if abs(factor) > least:
            total = _add(total, polynomial, factor)
    return total
