"""Attitude and angular velocity of a Lagrange top, factor by factor, and their constant phases."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal

import numpy as np

from omegadot.reference_impl.closed_forms.digits import ONE, ZERO, pi
from omegadot.reference_impl.closed_forms.elliptic import Clock, HyperbolicFrame
from omegadot.reference_impl.closed_forms.lagrange_constants import Nutation, Top
from omegadot.reference_impl.closed_forms.phase import Phase
from omegadot.reference_impl.closed_forms.shifted_theta_single import (
    Quotient,
    theta1_quotient,
    theta2_quotient,
)
from omegadot.reference_impl.closed_forms.theta import Frame, scaled
from omegadot.reference_impl.closed_forms.theta_series import Series
from omegadot.reference_impl.closed_forms.times import Times
from omegadot.reference_impl.system import Array


@dataclass(frozen=True)
class Factor:
    """One of α, β and ω_1 + i ω_2: ``scale exp(i rate t) Θ`` with Θ or Θ* as opposite states."""

    theta: Quotient
    rate: Decimal
    scale: Decimal
    opposite: bool

    def trajectory(self) -> Callable[[Times, Frame], Array]:
        """The factor as a function of time, up to a constant phase."""
        angle, theta = Phase.of(self.rate / (2 * pi()), ZERO), self.theta
        skew = -theta.skew if self.opposite else theta.skew
        series = Series.of(
            [
                scaled(theta.real, self.scale),
                scaled(theta.imaginary, self.scale if self.opposite else -self.scale),
                theta.below,
            ]
        )

        def value(times: Times, frame: Frame) -> Array:
            more = skew * frame.turn if isinstance(frame, HyperbolicFrame) else None
            spin = angle.circle(times, more)
            real, imaginary, divisor = series(frame)
            first, second = frame.sides if theta.kind == 1 else frame.sides[::-1]
            factor = np.empty(spin.shape, complex)
            np.divide(real * first, divisor, out=factor.real)
            np.divide(imaginary * second, divisor, out=factor.imag)
            spin *= factor
            return spin

        return value


def factors_of(top: Top, n: Nutation) -> tuple[Factor, Factor, Factor]:
    """α, β and ω_1 + i ω_2.

    With ``φ̇ = (b - a u)/(1 - u²)`` and ``ψ̇ = ω_3 - u φ̇`` the arguments change by

        α: (φ̇ + ψ̇)/2 = (ω_3 - a)/2 + (a + b) / 2(1 + u)
        β: (φ̇ - ψ̇)/2 = -(ω_3 - a)/2 + (b - a) / 2(1 - u)
        ω_1 + i ω_2:    -(ω_3 - a) - a/2 + (a height - b) / 2(height - u)

    the last from Euler's equations, ``d(ω_1 + iω_2)/dt = -i(ω_3 - a)(ω_1 + iω_2) - i(m g l/I_1)
    (v_1 + iv_2)`` with the vertical v in body axes. For each, ``u̇² = -k²`` where its denominator
    vanishes, k being the numerator.
    """
    u1, u2, u3 = n.roots
    rest = top.spin - n.a
    depth = n.modulus.argument(
        ((u3 - u1) / (ONE + u3)).sqrt(), (ONE + u1) / (ONE + u3), (ONE + u2) / (ONE + u3)
    )
    alpha = _factor(
        n, theta1_quotient(n.modulus, depth), rest / 2, n.a + n.b, ONE + u2, (ONE + u2) / 2
    )
    beta = _factor(n, _theta2(n, ONE), -rest / 2, n.b - n.a, ONE - u1, (ONE - u1) / 2)
    across = _factor(
        n,
        _theta2(n, n.height),
        -rest - n.a / 2,
        n.a * n.height - n.b,
        n.height - u1,
        n.strength * (n.height - u1),
    )
    return alpha, beta, across


def _theta2(n: Nutation, top: Decimal) -> Quotient:
    """The theta quotient whose square is ``(top - u)/(top - u_1)``, u_2 <= top <= u_3."""
    u1, u2, u3 = n.roots
    if u3 == u2:
        return theta2_quotient(n.modulus, n.modulus.complementary)
    above, below = max(u3 - top, ZERO), max(top - u2, ZERO)
    depth = n.modulus.argument(
        (above / (u3 - u2)).sqrt(), below / (u3 - u2), (top - u1) / (u3 - u1)
    )
    return theta2_quotient(n.modulus, depth)


def _factor(
    n: Nutation, theta: Quotient, base: Decimal, k: Decimal, there: Decimal, square: Decimal
) -> Factor:
    """The factor whose argument changes by ``base + k / 2D``, D being ``there`` at the reference.

    ``k / 2D`` has the residues ``∓ sign(k) i/2`` of ``- sign(k) d arg Θ/dt`` at the two zeros of D,
    so the two differ by a constant, found at the reference, u = 0 or K, where the slope is known.
    """
    sign = -1 if k < 0 else 1
    rate = base + k / (2 * there) + sign * n.rate * (theta.slope - theta.gain)
    return Factor(theta, rate, square.sqrt(), k < 0)


def phases_of(
    top: Top, n: Nutation, clock: Clock, trajectories: list[Callable[[Times, Frame], Array]]
) -> list[complex]:
    """The constant phases of the three factors, from their values at time zero.

    A factor that is nearly zero there has no definite phase: then it follows from the other two by
    ``ω_1 + iω_2 = 2 β α* (i (b - a u) - u̇) / (1 - u²)``, taken where none of them vanishes.
    """
    zero = Times(np.zeros(1))
    known = [complex(*map(float, pair)) for pair in (top.alpha, top.beta, top.across)]
    found = [complex(c(zero, clock.read(zero))[0]) for c in trajectories]
    greatest = [1.0, 1.0, float((n.strength * (n.height - n.roots[0])).sqrt())]
    sizes = [abs(x) / size for x, size in zip(known, greatest, strict=True)]
    phases = [x * y.conjugate() / (abs(x * y) or 1.0) for x, y in zip(known, found, strict=True)]
    least = min(range(3), key=lambda i: sizes[i])
    if sizes[least] > 0.01:
        return phases
    argument, bracket = _midway(n)
    away = Times(np.array([float((argument - n.start) / n.rate)]))
    alpha, beta, across = (complex(c(away, clock.read(away))[0]) for c in trajectories)
    relation = across * (beta * alpha.conjugate() * bracket).conjugate()
    relation /= abs(relation)
    a, b, c = phases
    if least == 0:
        a = b * (c * relation).conjugate()
    elif least == 1:
        b = c * relation * a
    else:
        c = b * a.conjugate() * relation.conjugate()
    return [a, b, c]


def _midway(n: Nutation) -> tuple[Decimal, complex]:
    """``u = K/2`` (on the separatrix ``u = 1``) and ``i (b - a cos θ) - d cos θ/dt`` there.

    With ``sn²(K/2) = 1/(1+k')``, ``cn²(K/2) = k'/(1+k')``, ``dn²(K/2) = k'``, DLMF 22.5(i).
    """
    u1, u2, u3 = n.roots
    k1 = n.modulus.m1.sqrt()
    argument, sn2, cn2, dn2 = n.modulus.quarter / 2, 1 / (1 + k1), k1 / (1 + k1), k1
    if n.modulus.m1 == 0:
        grown = ONE.exp()
        cn2 = (2 / (grown + 1 / grown)) ** 2
        argument, sn2, dn2 = ONE, ONE - cn2, cn2
    swing, span = u2 - u1, u3 - u1
    speed = swing * (n.strength * span * sn2 * cn2 * dn2).sqrt()
    return argument, complex(float(-speed), float(n.b - n.a * (u1 + swing * sn2)))
