"""The theta functions of a heavy top: zeros one to a cell of the full period lattice."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal

from omegadot.reference_impl.closed_forms.digits import (
    HALF,
    ONE,
    ZERO,
    Row,
    multiples,
    pi,
    power,
)
from omegadot.reference_impl.closed_forms.elliptic import Modulus
from omegadot.reference_impl.closed_forms.shifted_theta import ShiftedTheta
from omegadot.reference_impl.closed_forms.theta import (
    TERMS,
    cosines,
    odd_cosines,
    odd_sines,
    scaled,
    spread,
    times,
)


@dataclass(frozen=True)
class Quotient(ShiftedTheta):
    """``θ1(z + iη) / θ4(z)`` or ``θ2(z + iη) / θ4(z)``, of modulus one at the reference.

    below: rows of θ4(z).  kind: 1 or 2; the real row lacks the frame's side of that number, the
    imaginary row the other one.
    """

    below: tuple[Row, Row]
    kind: int


def theta2_quotient(modulus: Modulus, depth: Decimal) -> Quotient:
    """``θ2(z + iη) / θ4(z)``, one at u = 0; its zeros are at ``u = K ± i (K' - depth)``."""
    return _hyperbolic(modulus, depth, 2) if modulus.hyperbolic else _circular(modulus, depth, 2)


def theta1_quotient(modulus: Modulus, depth: Decimal) -> Quotient:
    """``θ1(z + iη) / θ4(z)``, its reference u = K; its zeros are at ``u = ± i (K' - depth)``."""
    return _hyperbolic(modulus, depth, 1) if modulus.hyperbolic else _circular(modulus, depth, 1)


def _circular(modulus: Modulus, depth: Decimal, kind: int) -> Quotient:
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
    first = [x * sign**n / size for n, x in enumerate(both)]
    second = [-sign * x * sign**n / size for n, x in enumerate(difference)]
    real, imaginary = (odd_sines, odd_cosines) if kind == 1 else (odd_cosines, odd_sines)
    return Quotient(
        (real(first), [ZERO]),
        (imaginary(second), [ZERO]),
        ONE,
        slope * pi() / (2 * modulus.quarter),
        ZERO,
        0.0,
        (times(cosines(theta4), 1 / reference), [ZERO]),
        kind,
    )


def _hyperbolic(modulus: Modulus, depth: Decimal, kind: int) -> Quotient:
    """``2 exp(-|v|)`` times ``θ4(w)`` or ``i θ1(w)`` of nome q1, ``w = η - iv``.

    Divided by ``2 exp(-|v|) θ2(iv)``, into which θ4(z) goes over.
    """
    q, k = modulus.complementary_nome, modulus.complementary
    eta = pi() * (k - depth) / (2 * k)
    below = [power(q, n * n) for n in range(TERMS)], [ZERO, *_oblong(q)]
    rows = _theta1_rows(q, eta) if kind == 1 else _theta4_rows(q, eta)
    far, near = (ONE, q) if kind == 1 else (q, ONE)  # far² and near² at the reference
    at = [_value(row[0], far) + _value(row[1], near) for row in (below, *rows)]
    size = (at[1] * at[1] + at[2] * at[2]).sqrt() / at[0]
    real, imaginary = (_in_powers(scaled(row, 1 / size), q, kind) for row in rows)
    skew = eta / pi() - HALF
    slope, gain = _theta4_slope(q, eta) * pi() / (2 * k), pi() * skew / modulus.quarter
    return Quotient(real, imaginary, ONE, slope, gain, float(skew), _in_powers(below, q, 1), kind)


def _in_powers(rows: tuple[Row, Row], q: Decimal, kind: int) -> tuple[Row, Row]:
    """Rows in powers of far² and near² as those of far and near; of kind 2 times near.

    ``near far = √q`` takes that factor into the powers of far.
    """
    if kind == 1:
        return spread(rows[0], 0), spread(rows[1], 0)
    return spread(times(rows[0], q.sqrt()), -1), spread(rows[1], 1)


def _oblong(q: Decimal) -> Row:
    return [power(q, n * n + n) for n in range(TERMS)]


def _theta1_rows(q: Decimal, eta: Decimal) -> list[tuple[Row, Row]]:
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
    return [(far[0], near[0]), (far[1], near[1])]


def _theta4_rows(q: Decimal, eta: Decimal) -> list[tuple[Row, Row]]:
    """``1 + Σ (-1)^n q^(n²) 2 (cos 2nη cosh 2nv , sin 2nη sinh 2n|v|)``, times 2."""
    far: tuple[Row, Row] = [ZERO], [ZERO]
    near: tuple[Row, Row] = [Decimal(2)], [ZERO]
    for n, (cosine, sine) in enumerate(multiples(2 * eta, TERMS)[1:], 1):
        less, square = 2 * (-1) ** n * power(q, n * n - n), 2 * (-1) ** n * power(q, n * n)
        far[0].append(less * cosine)
        far[1].append(less * sine)
        near[0].append(square * cosine)
        near[1].append(-square * sine)
    return [(far[0], near[0]), (far[1], near[1])]


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
