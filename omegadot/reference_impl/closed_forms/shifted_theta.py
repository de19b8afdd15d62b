"""Theta functions off the real axis: the periodic part of an attitude.

An elliptic integral of the third kind is a linear term and the argument of a theta function whose
argument is shifted along the imaginary axis (Whittaker and Watson, A Course of Modern Analysis,
22.74). The argument itself is never formed: the complex value, divided by its modulus, turns the
body.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal

import numpy as np

from omegadot.reference_impl.closed_forms.digits import ONE, ZERO, multiples, pi, power
from omegadot.reference_impl.closed_forms.elliptic import (
    CircularFrame,
    HyperbolicFrame,
    Modulus,
)
from omegadot.reference_impl.closed_forms.theta import TERMS, Frame, Polynomial, cosines, sines
from omegadot.reference_impl.system import Array


@dataclass(frozen=True)
class ShiftedTheta:
    """``Θ(u) = θ4(z + iη)`` of nome q², up to a positive factor, with u on a clock.

    value: complex, in a frame.  slope: ``d arg Θ / du`` at u = 0.  gain: the
    mean of ``d arg Θ / du`` over a period.  skew: ``arg Θ`` is ``gain u`` and a periodic
    part, which is ``arg value - 2π skew turn`` with the frame's turn.
    winding: the mean of what ``arg value`` does beyond the gain and a periodic part.
    """

    value: Callable[[Frame], Array]
    slope: Decimal
    gain: Decimal
    skew: float
    winding: Decimal = ZERO


def theta4_of_double_lattice(modulus: Modulus, depth: Decimal) -> ShiftedTheta:
    """The theta function whose zeros are at ``u = ± i (K' + depth)`` modulo 2K and 4iK'.

    depth: from 0 to K'.  Its nome is q², and q1^(1/2) after Jacobi's transformation.
    """
    return _hyperbolic(modulus, depth) if modulus.hyperbolic else _circular(modulus, depth)


def _circular(modulus: Modulus, depth: Decimal) -> ShiftedTheta:
    """``1 + Σ (-1)^n Q^(n²) 2 cos 2n(z + iη)``, ``Q = q²``, ``η = π (K' - depth) / 2K``."""
    q = modulus.nome
    growing = q * (-pi() * depth / modulus.quarter).exp()  # Q exp(2η), safe where q is zero
    decaying = q**3 * (pi() * depth / modulus.quarter).exp()  # Q exp(-2η)
    both, difference = [ONE], [ZERO]
    for n in range(1, TERMS):
        factor = (-1) ** n * power(q, 2 * (n * n - n))
        both.append(factor * (growing**n + decaying**n))
        difference.append(-factor * (growing**n - decaying**n))
    real, imaginary = Polynomial.of(cosines(both)), Polynomial.of(sines(difference))
    rise = sum((2 * n * c for n, c in enumerate(difference)), ZERO) / sum(both, ZERO)

    def value(frame: Frame) -> Array:
        assert isinstance(frame, CircularFrame)
        y = frame.square
        theta = np.empty(y.shape, complex)
        theta.real = real(y)
        np.multiply(imaginary(y), frame.sine * frame.cosine, out=theta.imag)
        return theta

    return ShiftedTheta(value, rise * pi() / (2 * modulus.quarter), ZERO, 0.0)


def _hyperbolic(modulus: Modulus, depth: Decimal) -> ShiftedTheta:
    """``2 exp(-|v|/2) Σ p^(n²+n) cos (2n+1)w``, ``p = √q1``, ``w = η - iv/2``."""
    p = modulus.complementary_nome.sqrt()
    k = modulus.complementary
    eta = pi() * (k - depth) / (4 * k)
    real_far, real_near, imaginary_far, imaginary_near = [], [ZERO], [], [ZERO]
    rise, size = ZERO, ZERO
    for n, (cosine, sine) in enumerate(multiples(eta, 2 * TERMS)[1::2]):
        square, oblong = power(p, n * n), power(p, n * n + n)
        real_far.append(square * cosine)
        real_near.append(oblong * cosine)
        imaginary_far.append(square * sine)
        imaginary_near.append(-oblong * sine)
        rise += (2 * n + 1) * oblong * sine
        size += oblong * cosine
    polynomials = [
        Polynomial.of(row) for row in (real_far, real_near, imaginary_far, imaginary_near)
    ]

    def value(frame: Frame) -> Array:
        assert isinstance(frame, HyperbolicFrame)
        far0, near0, far1, near1 = polynomials
        theta = np.empty(frame.near.shape, complex)
        np.add(far0(frame.far), near0(frame.near), out=theta.real)
        side = far1(frame.far)
        side += near1(frame.near)
        np.multiply(side, frame.side, out=theta.imag)
        return theta

    return ShiftedTheta(
        value, rise / size * pi() / (4 * k), eta / modulus.quarter, float(eta / pi())
    )
