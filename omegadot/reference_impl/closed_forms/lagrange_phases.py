"""The constant phases of a Lagrange top's factors."""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal

import numpy as np

from omegadot.reference_impl.closed_forms.digits import ONE
from omegadot.reference_impl.closed_forms.elliptic import Clock
from omegadot.reference_impl.closed_forms.lagrange_constants import Nutation, Top
from omegadot.reference_impl.closed_forms.theta import Frame
from omegadot.reference_impl.closed_forms.times import Times
from omegadot.reference_impl.system import Array


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
