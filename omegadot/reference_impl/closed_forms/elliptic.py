"""Jacobi's functions by the complementary parameter: modulus, nomes, clock.

Every function here is a quotient of theta series. With the nome q the series run in
circular functions of ``z = π u / 2K``; with the complementary nome q1 (Jacobi's imaginary
transformation, DLMF 20.7(viii)) in exponentials of ``v = π u / 2K'``. One of the two is short:
either q is at most ``exp(-π/2) = 0.21`` or q1 at most ``exp(-2π) = 0.002``. The separatrix m1 = 0
is the plain limit ``q1 = 0`` of the second kind.
"""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal
from functools import cached_property
from math import exp

import numpy as np

from omegadot.reference_impl.closed_forms.digits import (
    INFINITY,
    ONE,
    TWO,
    ZERO,
    agm,
    carlson_rf,
    pi,
)
from omegadot.reference_impl.closed_forms.phase import Phase
from omegadot.reference_impl.closed_forms.times import Times
from omegadot.reference_impl.system import Array


@dataclass(frozen=True)
class Modulus:
    """Parameter m, complementary parameter m1 = 1 - m, quarter periods and nomes.

    quarter: ``K = π / 2 agm(1, √m1)``, complementary: ``K' = π / 2 agm(1, √m)`` (DLMF 19.8.5),
    infinite where m1 or m is zero.  nome: ``q = exp(-π K'/K)`` (DLMF 22.2.1), complementary_nome:
    ``q1 = exp(-π K/K')``.
    """

    m: Decimal
    m1: Decimal
    quarter: Decimal
    complementary: Decimal

    @classmethod
    def of(cls, m: Decimal, m1: Decimal) -> Modulus:
        """M and m1 are given both, each free of cancellation; one of them may be zero."""
        half_pi = pi() / 2
        mean, complementary_mean = agm(ONE, m1.sqrt()), agm(ONE, m.sqrt())
        return cls(
            m,
            m1,
            half_pi / mean if mean else INFINITY,
            half_pi / complementary_mean if complementary_mean else INFINITY,
        )

    @cached_property
    def nome(self) -> Decimal:
        """The nome q, zero where m is, one on the separatrix."""
        return (-pi() * self.complementary / self.quarter).exp() if self.m else ZERO

    @cached_property
    def complementary_nome(self) -> Decimal:
        """The complementary nome q1, zero on the separatrix, one where m is zero."""
        return (-pi() * self.quarter / self.complementary).exp() if self.m1 else ZERO

    @property
    def hyperbolic(self) -> bool:
        """Whether the series in exponentials are the short ones: K > 2 K', m above 0.97."""
        return self.quarter > TWO * self.complementary

    def argument(self, sn: Decimal, cn_square: Decimal, dn_square: Decimal) -> Decimal:
        """The u from -K to K with this sn u: ``sn R_F(cn², dn², 1)``, DLMF 19.25.5.

        The squares are returned with sn, so that none of them is formed as ``1 - sn²``.
        """
        return sn * carlson_rf(cn_square, dn_square, ONE) if sn else ZERO


@dataclass(frozen=True)
class CircularFrame:
    """sin z, cos z and sin² z."""

    sine: Array
    cosine: Array
    square: Array

    @property
    def bases(self) -> tuple[Array, Array]:
        """What the series are polynomials of."""
        return self.square, self.square

    @property
    def odd_even(self) -> tuple[Array, Array, Array]:
        """The factors that turn their sign with u, at the half period, and their product."""
        return self.sine, self.cosine, self.sine * self.cosine

    @property
    def sides(self) -> tuple[Array, Array]:
        """The factors without the sign of half periods, which a skew accounts for."""
        return self.sine, self.cosine


@dataclass(frozen=True)
class HyperbolicFrame:
    """``near = exp(-|v|)`` and ``far = exp(|v| - v_K)`` for u reduced by 2K to |u| <= K.

    turn: the reduced u / 2K, from -1/2 to 1/2 (zero on the separatrix); side: the sign of the
    reduced u; sign: -1 after an odd number of half periods 2K, else 1.
    """

    near: Array
    far: Array
    side: Array
    sign: Array
    turn: Array

    @property
    def bases(self) -> tuple[Array, Array]:
        """What the series are polynomials of."""
        return self.far, self.near

    @property
    def odd_even(self) -> tuple[Array, Array, Array]:
        """The factors that turn their sign with u, at the half period, and their product."""
        return self.side * self.sign, self.sign, self.side

    @property
    def sides(self) -> tuple[Array, Array]:
        """The factors without the sign of half periods, which a skew accounts for."""
        return self.side, np.ones_like(self.side)


@dataclass(frozen=True)
class Clock:
    """``u(t) = rate t + start``, read off in the frame that suits the modulus.

    phase: u in units of 4K; of 2K where the frame is hyperbolic; of 1 on the separatrix.
    span: ``2 v_K = π K / K'`` where the frame is hyperbolic.
    """

    phase: Phase
    hyperbolic: bool
    span: float

    @classmethod
    def of(cls, modulus: Modulus, rate: Decimal, start: Decimal) -> Clock:
        """Rate in 1/s; start is u at time zero."""
        if modulus.m1 == 0:
            return cls(Phase.of(rate, start), True, np.inf)
        if modulus.hyperbolic:
            period = 2 * modulus.quarter
            span = float(pi() * modulus.quarter / modulus.complementary)
        else:
            period, span = 4 * modulus.quarter, 0.0
        return cls(Phase.of(rate / period, start / period), modulus.hyperbolic, span)

    def read(self, times: Times) -> CircularFrame | HyperbolicFrame:
        """The frame at the times."""
        if not self.hyperbolic:
            circle = self.phase.circle(times)
            sine = circle.imag.copy()
            return CircularFrame(sine, circle.real.copy(), sine * sine)
        if np.isinf(self.span):
            u = self.phase.at(times)
            nothing = np.zeros_like(u)
            near = np.exp(-np.abs(u))
            return HyperbolicFrame(near, nothing, np.copysign(1.0, u), nothing + 1.0, nothing)
        whole, turn = self.phase.reduced(times)
        distance = np.abs(turn)
        distance *= -self.span
        near = np.exp(distance, out=distance)
        far = exp(-0.5 * self.span) / near
        # n mod 2 by arithmetic: |n/2 - rint(n/2)| is 0 or 1/2
        whole *= 0.5
        whole -= np.rint(whole)
        np.abs(whole, out=whole)
        whole *= -4.0
        whole += 1.0
        return HyperbolicFrame(near, far, np.copysign(1.0, turn), whole, turn)
