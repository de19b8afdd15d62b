"""Theta functions off the real axis: the periodic part of an attitude.

An elliptic integral of the third kind is a linear term and the argument of a theta function whose
argument is shifted along the imaginary axis (Whittaker and Watson, A Course of Modern Analysis,
22.74). The argument itself is never formed: the complex value, divided by its modulus, turns the
body.
"""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal

from omegadot.reference_impl.closed_forms.digits import ONE, ZERO, Row, multiples, pi, power
from omegadot.reference_impl.closed_forms.elliptic import Modulus
from omegadot.reference_impl.closed_forms.theta import cosines, sines, terms


@dataclass(frozen=True)
class ShiftedTheta:
    """``Θ(u) = θ(z + iη)``, up to a positive factor, as series in a clock's frame.

    real, imaginary: rows of a ``Series``, which lack factors of the frame.  start: the value at the
    reference, u = 0 unless given.  slope: ``d arg Θ / du`` there.  gain: the mean of
    ``d arg Θ / du`` over a period.  skew: ``arg Θ`` is ``gain u`` and a periodic part, which is the
    argument of the series less ``2π skew turn`` with the frame's turn.
    """

    real: tuple[Row, Row]
    imaginary: tuple[Row, Row]
    start: Decimal
    slope: Decimal
    gain: Decimal
    skew: float


def theta4_of_double_lattice(modulus: Modulus, depth: Decimal) -> ShiftedTheta:
    """``θ4(z + iη)`` of nome q², whose zeros are at ``u = ± i (K' + depth)`` modulo 2K and 4iK'.

    depth: from 0 to K'.  After Jacobi's transformation its nome is q1^(1/2). The imaginary row
    lacks the frame's third factor, and the start is real.
    """
    return _hyperbolic(modulus, depth) if modulus.hyperbolic else _circular(modulus, depth)


def _circular(modulus: Modulus, depth: Decimal) -> ShiftedTheta:
    """``1 + Σ (-1)^n Q^(n²) 2 cos 2n(z + iη)``, ``Q = q²``, ``η = π (K' - depth) / 2K``."""
    q = modulus.nome
    grown = (pi() * depth / modulus.quarter).exp()
    growing, decaying = q / grown, q**3 * grown  # Q exp(±2η), safe where q is zero
    both, difference = [ONE], [ZERO]
    for n in range(1, terms(q)):
        factor = (-1) ** n * power(q, 2 * (n * n - n))
        both.append(factor * (growing**n + decaying**n))
        difference.append(-factor * (growing**n - decaying**n))
    rise = sum((2 * n * c for n, c in enumerate(difference)), ZERO) / sum(both, ZERO)
    return ShiftedTheta(
        (cosines(both), [ZERO]),
        (sines(difference), [ZERO]),
        sum(both, ZERO),
        rise * pi() / (2 * modulus.quarter),
        ZERO,
        0.0,
    )


def _hyperbolic(modulus: Modulus, depth: Decimal) -> ShiftedTheta:
    """``2 exp(-|v|/2) Σ p^(n²+n) cos (2n+1)w``, ``p = √q1``, ``w = η - iv/2``."""
    p = modulus.complementary_nome.sqrt()
    k = modulus.complementary
    eta = pi() * (k - depth) / (4 * k)
    real_far, real_near, imaginary_far, imaginary_near = [], [ZERO], [], [ZERO]
    rise, size = ZERO, ZERO
    for n, (cosine, sine) in enumerate(multiples(eta, 2 * terms(p))[1::2]):
        square, oblong = power(p, n * n), power(p, n * n + n)
        real_far.append(square * cosine)
        real_near.append(oblong * cosine)
        imaginary_far.append(square * sine)
        imaginary_near.append(-oblong * sine)
        rise += (2 * n + 1) * oblong * sine
        size += oblong * cosine
    return ShiftedTheta(
        (real_far, real_near),
        (imaginary_far, imaginary_near),
        2 * size,
        rise / size * pi() / (4 * k),
        eta / modulus.quarter,
        float(eta / pi()),
    )
