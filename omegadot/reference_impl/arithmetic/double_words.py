"""Arithmetic of numbers that are pairs of doubles, ``high + low`` with ``|low| <= ulp(high)/2``.

106 bits and the range of a double. It needs no more than rounding to nearest, so every platform
gives the same digits. Sum, product, quotient and root err by a few ``u²`` with ``u = 2^-53``.

Sources: T. J. Dekker, A floating-point technique for extending the available precision, Numer.
Math. 18 (1971) 224-242; M. Joldes, J.-M. Muller and V. Popescu, Tight and rigorous error bounds for
basic building blocks of double-word arithmetic, ACM TOMS 44 (2017) 15res, algorithms 6, 10 and 17;
S. M. Rump, T. Ogita and S. Oishi, Accurate floating-point summation part I, SIAM J. Sci. Comput. 31
(2008) 189-224, section 3, for sums.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from omegadot.reference_impl.system import Array

Pair: TypeAlias = tuple[Array, Array]
SPLITTER = 2.0**27 + 1.0


def two_sum(a: Array, b: Array) -> Pair:
    """``a + b`` rounded, and its rounding error: Knuth's, for any a and b."""
    total = a + b
    of_b = total - a
    return total, (a - (total - of_b)) + (b - of_b)


def fast_two_sum(a: Array, b: Array) -> Pair:
    """The same where ``|a| >= |b|``: Dekker's."""
    total = a + b
    return total, b - (total - a)


def split(a: Array) -> Pair:
    """The leading 26 bits and the rest, exactly: Veltkamp's."""
    scaled = SPLITTER * a
    leading = scaled - (scaled - a)
    return leading, a - leading


def two_product(a: Array, b: Array) -> Pair:
    """``a b`` rounded, and its rounding error: Dekker's."""
    product = a * b
    a1, a2 = split(a)
    b1, b2 = split(b)
    return product, a2 * b2 - (((product - a1 * b1) - a2 * b1) - a1 * b2)


def add(a: Pair, b: Pair) -> Pair:
    """``a + b``, algorithm 6."""
    high, error = two_sum(a[0], b[0])
    low, least = two_sum(a[1], b[1])
    high, error = fast_two_sum(high, error + low)
    return fast_two_sum(high, error + least)


def subtract(a: Pair, b: Pair) -> Pair:
    """``a - b``."""
    return add(a, negative(b))


def negative(a: Pair) -> Pair:
    """``-a``."""
    return -a[0], -a[1]


def absolute(a: Pair) -> Pair:
    """``|a|``."""
    sign = np.where(a[0] < 0, -1.0, 1.0)
    return sign * a[0], sign * a[1]


def multiply(a: Pair, b: Pair) -> Pair:
    """``a b``, algorithm 10."""
    high, error = two_product(a[0], b[0])
    return fast_two_sum(high, error + (a[0] * b[1] + a[1] * b[0]))


def divide(a: Pair, b: Pair) -> Pair:
    """``a / b``: the double's quotient, and what it leaves by algorithm 17."""
    quotient = a[0] / b[0]
    rest = subtract(a, multiply((quotient, np.zeros_like(quotient)), b))[0]
    return fast_two_sum(quotient, rest / b[0])


def root(a: Pair) -> Pair:
    """``√a``: one step of Newton's from the double's root; a root of zero stays there."""
    high = np.sqrt(a[0])
    rest = subtract(a, two_product(high, high))[0]
    return fast_two_sum(high, rest / np.where(high == 0.0, 1.0, 2.0 * high))


def total(a: Pair, axis: int) -> Pair:
    """The sum along an axis."""
    return _total(a[0], axis, np.add.reduce(a[1], axis))


def matrix_product(a: Pair, b: Pair) -> Pair:
    """``a @ b``: (..., n, m) and (..., m, p) to (..., n, p)."""
    terms, errors = two_product(a[0][..., None], b[0][..., None, :, :])
    return _total(terms, -2, np.add.reduce(errors, -2) + (a[0] @ b[1] + a[1] @ b[0]))


def _total(terms: Array, axis: int, rest: Array) -> Pair:
    """Sum along an axis, with what the terms leave out: to ``n² u²`` of the largest term.

    Added to and taken from a power of two that is more than n times the largest term, each keeps
    its leading bits, which are summed without rounding.
    """
    largest = np.max(np.abs(terms), axis, keepdims=True)
    power = np.ldexp(1.0, np.frexp(largest)[1] + (terms.shape[axis] + 2).bit_length())
    leading = (power + terms) - power
    return two_sum(np.add.reduce(leading, axis), np.add.reduce(terms - leading, axis) + rest)
