"""Theta series as polynomials, for the two frames of a clock.

``Σ a_n cos 2nz`` and its kin are polynomials in ``sin² z``; their counterparts with the
complementary nome are polynomials in the two decaying exponentials. The coefficients are worked
out with many digits and rounded once.
"""

from __future__ import annotations

from collections.abc import Sequence
from decimal import Decimal
from functools import cache
from itertools import zip_longest
from operator import mul
from typing import TypeAlias

from omegadot.reference_impl.closed_forms.digits import ONE, ZERO, Row, power
from omegadot.reference_impl.closed_forms.elliptic import (
    CircularFrame,
    HyperbolicFrame,
    Modulus,
)

Frame: TypeAlias = CircularFrame | HyperbolicFrame

TERMS = 9  # the ninth term of every series here is below 1e-20 of the first
_LEAST = Decimal("1e-24")


def jacobi_rows(modulus: Modulus, sn: Decimal, cn: Decimal, dn: Decimal) -> list[tuple[Row, Row]]:
    """Series of ``sn · sn u, cn · cn u, dn · dn u``, the factors given, and of what divides them.

    That is one at u = 0. The first lacks the frame's odd factor and the second its even one. DLMF
    22.2.4-22.2.6 with the series 20.2.1-20.2.4; near the separatrix after Jacobi's imaginary
    transformation, DLMF 20.7.30-20.7.33.
    """
    return (
        _hyperbolic_jacobi(modulus.complementary_nome, sn, cn, dn)
        if modulus.hyperbolic
        else _circular_jacobi(modulus.nome, sn, cn, dn)
    )


def terms(q: Decimal) -> int:
    """How many terms the series ``Σ q^(n²)`` has before they fall below 1e-24."""
    return next(n for n in range(1, TERMS + 1) if power(q, n * n) < _LEAST)


def _circular_jacobi(q: Decimal, sn: Decimal, cn: Decimal, dn: Decimal) -> list[tuple[Row, Row]]:
    count = terms(q)
    odd = [power(q, n * n + n) for n in range(count)]
    even = [ONE] + [2 * power(q, n * n) for n in range(1, count)]
    odd1, even4 = _alternating(odd), _alternating(even)
    theta2, theta3, theta4 = sum(odd, ZERO), sum(even, ZERO), sum(even4, ZERO)
    rows = [
        (odd_sines(odd1), sn * theta3 / (theta2 * theta4)),
        (odd_cosines(odd), cn / theta2),
        (cosines(even), dn / theta3),
        (cosines(even4), 1 / theta4),
    ]
    return [(times(row, factor), [ZERO]) for row, factor in rows]


def _hyperbolic_jacobi(q: Decimal, sn: Decimal, cn: Decimal, dn: Decimal) -> list[tuple[Row, Row]]:
    """In powers of far and near: those of q are shared out so that no exponential grows.

    ``near far = √q``, which takes the factor near of the last two into their powers.
    """
    count, root = terms(q) + 1, q.sqrt()  # one more: the shorter powers are n² - n
    square = [power(q, n * n) for n in range(count)]
    oblong = [power(q, n * n + n) for n in range(count)]
    shorter = [ZERO] + [power(q, n * n - n) for n in range(1, count)]
    theta2 = sum(oblong, ZERO)
    theta3 = ONE + 2 * sum(square[1:], ZERO)
    theta4 = ONE + 2 * sum(_alternating(square)[1:], ZERO)
    sn, cn, dn, one = (
        sn * theta3 / (2 * theta2 * theta4),
        cn / theta4,
        dn / theta3,
        1 / (2 * theta2),
    )
    crossed = [-x for x in _alternating(oblong)]
    lower = _alternating(shorter)
    return [
        (spread(times(_alternating(square), sn), 0), spread(times(crossed, sn), 2)),
        (spread(times(lower, cn * root), -1), spread(times(_alternating(square), cn), 1)),
        (spread(times(shorter, dn * root), -1), spread(times(square, dn), 1)),
        (spread(times(square, one), 0), spread(times(oblong, one), 2)),
    ]


def _alternating(row: Row) -> Row:
    return [-x if n % 2 else x for n, x in enumerate(row)]


def scaled(rows: tuple[Row, Row], factor: Decimal) -> tuple[Row, Row]:
    """Both parts of a series times a factor."""
    return times(rows[0], factor), times(rows[1], factor)


def times(row: Row, factor: Decimal) -> Row:
    """The row times a factor."""
    return [factor * x for x in row]


def spread(row: Row, lowest: int) -> Row:
    """Coefficients of ``x^(2n + lowest)`` as those of all powers of x."""
    spread = [ZERO] * (2 * len(row) + max(lowest, 0))
    for n, x in enumerate(row):
        if x:
            spread[2 * n + lowest] = x
    return spread


def cosines(a: Sequence[Decimal]) -> Row:
    """``Σ a_n cos 2nz`` as a polynomial in ``y = sin² z``."""
    return _combine(a, _first_kind(len(a)))


def sines(a: Sequence[Decimal]) -> Row:
    """``Σ a_n sin 2nz / (sin z cos z)`` as a polynomial in y; a_0 does not matter."""
    return [2 * c for c in _combine(a[1:], _second_kind(len(a) - 1))] if len(a) > 1 else [ZERO]


def odd_sines(a: Sequence[Decimal]) -> Row:
    """``Σ a_n sin (2n+1)z / sin z`` as a polynomial in y."""
    return _combine(a, _neighbours(len(a), 1))


def odd_cosines(a: Sequence[Decimal]) -> Row:
    """``Σ a_n cos (2n+1)z / cos z`` as a polynomial in y."""
    return _combine(a, _neighbours(len(a), -1))


# Whole numbers that only depend on how many are wanted: formed once, column by column. Those of
# the polynomials of degree n are the n-th ones of each column.
@cache
def _first_kind(count: int) -> list[Row]:
    return _columns(_chebyshev(count, [1, -2]))


@cache
def _second_kind(count: int) -> list[Row]:
    return _columns(_chebyshev(count, [2, -4]))


@cache
def _neighbours(count: int, sign: int) -> list[Row]:
    u = _chebyshev(count, [2, -4])
    return _columns([u[0]] + [_sum(u[n], u[n - 1], sign) for n in range(1, count)])


def _chebyshev(count: int, first: list[int]) -> list[list[int]]:
    """Chebyshev polynomials of ``cos 2z = 1 - 2y``, as polynomials in y."""
    polynomials = [[1], first]
    while len(polynomials) < count:
        last = polynomials[-1]
        doubled = _sum([2 * c for c in last], [0] + [-4 * c for c in last], 1)
        polynomials.append(_sum(doubled, polynomials[-2], -1))
    return polynomials[:count]


def _sum(p: list[int], q: list[int], factor: int) -> list[int]:
    return [a + factor * b for a, b in zip_longest(p, q, fillvalue=0)]


def _columns(polynomials: list[list[int]]) -> list[Row]:
    """The coefficients of ``y^k`` from the k-th polynomial, of degree k, onwards."""
    return [[Decimal(p[k]) for p in polynomials[k:]] for k in range(len(polynomials))]


def _combine(a: Sequence[Decimal], columns: list[Row]) -> Row:
    return [sum(map(mul, a[k:], column), ZERO) for k, column in enumerate(columns)]
