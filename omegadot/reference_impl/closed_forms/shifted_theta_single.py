"""The theta functions of a heavy top: zeros one to a cell of the full period lattice."""

from __future__ import annotations

from decimal import Decimal

import numpy as np

from omegadot.reference_impl.closed_forms.digits import (
    HALF,
    ONE,
    ZERO,
    Row,
    multiples,
    pi,
    power,
)
from omegadot.reference_impl.closed_forms.elliptic import (
    CircularFrame,
    HyperbolicFrame,
    Modulus,
)
from omegadot.reference_impl.closed_forms.shifted_theta import ShiftedTheta
from omegadot.reference_impl.closed_forms.theta import (
    TERMS,
    Frame,
    Polynomial,
    cosines,
    odd_cosines,
    odd_sines,
)
from omegadot.reference_impl.system import Array


def theta2_quotient(modulus: Modulus, depth: Decimal) -> ShiftedTheta:
    """``θ2(z + iη) / θ4(z)``, one at u = 0; its zeros are at ``u = K ± i (K' - depth)``."""
    return _hyperbolic(modulus, depth, 2) if modulus.hyperbolic else _circular(modulus, depth, 2)


def theta1_quotient(modulus: Modulus, depth: Decimal) -> ShiftedTheta:
    """``θ1(z + iη) / θ4(z)``, of modulus one at u = K; its zeros are at ``u = ± i (K' - depth)``.

    The slope is that at u = K.
    """
    return _hyperbolic(modulus, depth, 1) if modulus.hyperbolic else _circular(modulus, depth, 1)


def _circular(modulus: Modulus, depth: Decimal, kind: int) -> ShiftedTheta:
    """``Σ q^(n²+n) cos (2n+1)(z + iη)`` and its fellow with sines of alternating sign."""
    q = modulus.nome
    shrink = (-pi() * depth / modulus.quarter).exp()  # q exp(2η)
    growing = [power(q, n * n) * shrink**n for n in range(TERMS)]
    decaying = [power(q, n * n + n) * (q / shrink) ** (n + 1) for n in range(TERMS)]
    both = [x + y for x, y in zip(growing, decaying, strict=True)]
    difference = [x - y for x, y in zip(growing, decaying, strict=True)]
    size = sum(both, ZERO)
    slope = -sum(((2 * n + 1) * x for n, x in enumerate(difference)), ZERO) / size
    sign = -1 if kind == 1 else 1
    theta4 = [ONE] + [2 * (-1) ** n * power(q, n * n) for n in range(1, TERMS)]
    reference = sum((x * sign**n for n, x in enumerate(theta4)), ZERO)
    below = Polynomial.of([x / reference for x in cosines(theta4)])
    first = [x * sign**n / size for n, x in enumerate(both)]
    second = [sign * x * sign**n / size for n, x in enumerate(difference)]
    if kind == 1:
        real, imaginary = Polynomial.of(odd_sines(first)), Polynomial.of(odd_cosines(second))
    else:
        real, imaginary = Polynomial.of(odd_cosines(first)), Polynomial.of(odd_sines(second))

    def value(frame: Frame) -> Array:
        assert isinstance(frame, CircularFrame)
        y = frame.square
        inverse = 1.0 / below(y)
        theta = np.empty(y.shape, complex)
        sides = (frame.sine, frame.cosine) if kind == 1 else (frame.cosine, frame.sine)
        theta.real = real(y) * sides[0] * inverse
        theta.imag = -(imaginary(y) * sides[1] * inverse)
        return theta

    half = pi() / (2 * modulus.quarter)
    return ShiftedTheta(value, slope * half, ZERO, 0.0)


def _hyperbolic(modulus: Modulus, depth: Decimal, kind: int) -> ShiftedTheta:
    """``2 exp(-|v|)`` times ``θ4(w)`` or ``i θ1(w)`` of nome q1, ``w = η - iv``.

    Divided by ``2 exp(-|v|) θ2(iv)``, into which θ4(z) goes over.
    """
    q, k = modulus.complementary_nome, modulus.complementary
    eta = pi() * (k - depth) / (2 * k)
    below = [[power(q, n * n) for n in range(TERMS)], [ZERO, *_oblong(q)]]
    rows = _theta1_rows(q, eta) if kind == 1 else _theta4_rows(q, eta)
    far, near = (ONE, q) if kind == 1 else (q, ONE)  # far² and near² at the reference
    at = [_value(row[0], far) + _value(row[1], near) for row in (below, rows[:2], rows[2:])]
    size = (at[1] * at[1] + at[2] * at[2]).sqrt() / at[0]
    below_far, below_near = map(Polynomial.of, below)
    polynomials = [Polynomial.of([x / size for x in row]) for row in rows]

    def value(frame: Frame) -> Array:
        assert isinstance(frame, HyperbolicFrame)
        a, g = frame.near * frame.near, frame.far * frame.far
        inverse = 1.0 / (below_far(g) + below_near(a))
        if kind == 2:
            inverse *= frame.near
        theta = np.empty(a.shape, complex)
        theta.real = (polynomials[0](g) + polynomials[1](a)) * inverse
        theta.imag = (polynomials[2](g) + polynomials[3](a)) * inverse
        odd = theta.real if kind == 1 else theta.imag
        odd *= frame.side
        return theta

    skew = eta / pi() - HALF
    gain = pi() * skew / modulus.quarter
    return ShiftedTheta(value, _theta4_slope(q, eta) * pi() / (2 * k), gain, float(skew))


def _oblong(q: Decimal) -> Row:
    return [power(q, n * n + n) for n in range(TERMS)]


def _theta1_rows(q: Decimal, eta: Decimal) -> tuple[Row, Row, Row, Row]:
    """``Σ (-1)^n q^(n²+n) (cos kη sinh k|v| , sin kη cosh kv)``, k = 2n+1, times 2 exp(-|v|).

    In powers of far² and near², the powers of q shared out so that no exponential grows.
    """
    far: tuple[Row, Row] = [], []
    near: tuple[Row, Row] = [ZERO], [ZERO]
    angles = multiples(eta, 2 * TERMS)[1::2]
    for n, (oblong, (cosine, sine)) in enumerate(zip(_oblong(q), angles, strict=True)):
        sign, square = (-1) ** n, power(q, n * n)
        far[0].append(sign * square * cosine)
        far[1].append(sign * square * sine)
        near[0].append(-sign * oblong * cosine)
        near[1].append(sign * oblong * sine)
    return far[0], near[0], far[1], near[1]


def _theta4_rows(q: Decimal, eta: Decimal) -> tuple[Row, Row, Row, Row]:
    """``1 + Σ (-1)^n q^(n²) 2 (cos 2nη cosh 2nv , sin 2nη sinh 2n|v|)``, times 2."""
    far: tuple[Row, Row] = [ZERO], [ZERO]
    near: tuple[Row, Row] = [Decimal(2)], [ZERO]
    for n, (cosine, sine) in enumerate(multiples(2 * eta, TERMS)[1:], 1):
        less, square = 2 * (-1) ** n * power(q, n * n - n), 2 * (-1) ** n * power(q, n * n)
        far[0].append(less * cosine)
        far[1].append(less * sine)
        near[0].append(square * cosine)
        near[1].append(-square * sine)
    return far[0], near[0], far[1], near[1]


def _theta4_slope(q: Decimal, eta: Decimal) -> Decimal:
    """``d arg θ4(η - iv) / dv`` at v = 0, and the same of ``i θ1`` half a period away."""
    slope, size = ZERO, ONE
    for n, (cosine, sine) in enumerate(multiples(2 * eta, TERMS)[1:], 1):
        term = 2 * (-1) ** n * power(q, n * n)
        slope += 2 * n * term * sine
        size += term * cosine
    return slope / size


def _value(coefficients: Row, x: Decimal) -> Decimal:
    return sum((c * power(x, n) for n, c in enumerate(coefficients)), ZERO)
