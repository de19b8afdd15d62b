"""The heavy symmetric top of Lagrange: nutation, precession and spin.

Nutation: Landau and Lifshitz, Mechanics, section 35, problem 1; Whittaker, A Treatise on the
Analytical Dynamics of Particles and Rigid Bodies, section 71. Precession and spin are third-kind
integrals; with the Cayley-Klein parameters of Klein and Sommerfeld (Über die Theorie des Kreisels)
each of them is one theta quotient times an exponential of the time,

    α ~ exp(iμt) θ1(z ± iη)/θ4(z),  |α|² = (1 + u)/2,
    β ~ exp(iμt) θ2(z ± iη)/θ4(z),  |β|² = (1 - u)/2,
    ω_1 + i ω_2 ~ exp(iμt) θ2(z ± iη)/θ4(z),  |ω_1 + i ω_2|² = strength (height - u),

with an η and a μ of its own each. Nothing is divided by sin θ, so the top may pass through the
vertical. The constants follow from the phases' derivatives, derived in
``lagrange_factors.py``.
"""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.closed_forms.digits import (
    RESOLUTION,
    Row,
    apply,
    dot,
    many_digits,
)
from omegadot.reference_impl.closed_forms.elliptic import Clock
from omegadot.reference_impl.closed_forms.free_rotation import uniform
from omegadot.reference_impl.closed_forms.given import Given
from omegadot.reference_impl.closed_forms.lagrange_constants import (
    Nutation,
    Top,
    nutation_of,
    top_of,
    triad,
)
from omegadot.reference_impl.closed_forms.lagrange_factors import factors_of, phases_of
from omegadot.reference_impl.closed_forms.problem import (
    MeasuredRun,
    Motion,
    Placed,
    Problem,
    place,
    placing_of,
)
from omegadot.reference_impl.closed_forms.times import Times
from omegadot.reference_impl.system import Array


def lagrange_top_of(given: Given) -> Problem | None:
    """The body as a Lagrange top, or None where it is none.

    The lever from the pivot to the centre of mass must be an axis of symmetry of the inertia about
    the pivot, as the given numbers stand; a tensor that is symmetric up to rounding only is not.
    Numbers: transverse and axial moment about the pivot, mass, lever (3), gravity (3), angular
    velocity (3), orientation (4).
    """
    if not given.hangs or given.driven or given.damping:
        return None
    axes = triad(given.lever)
    turned = [apply(given.inertia, axis) for axis in axes]
    rows = [[dot(axis, x) for x in turned] for axis in axes]
    transverse, axial = rows[0][0], rows[2][2]
    off = [rows[0][1], rows[1][0], rows[0][2], rows[1][2], rows[2][0], rows[2][1]]
    off.append(rows[1][1] - transverse)
    if max(abs(x) for x in off) > RESOLUTION * transverse:
        return None
    numbers = [transverse, axial, given.mass, *given.lever, *given.gravity]
    return Problem("Lagrange top", [*numbers, *given.omega, *given.orientation], _solve)


def _solve(numbers: Row) -> Motion:
    with many_digits():
        top = top_of(numbers[2:], numbers[0], numbers[1])
        nutation = nutation_of(top)
        if nutation is None:
            return place(uniform(numbers[9:12]), numbers[12:])
        placing = placing_of(top.world, top.body)
        return Placed(_trajectory(top, nutation), np.array(top.axes, float), placing)


def _trajectory(top: Top, n: Nutation) -> MeasuredRun:
    clock = Clock.of(n.modulus, n.rate, n.start)
    trajectories = [factor.trajectory() for factor in factors_of(top, n)]
    phases = phases_of(top, n, clock, trajectories)
    spin = float(top.spin)

    def trajectory(times: Times, w: Array, q: Array) -> None:
        frame = clock.read(times)
        alpha, beta, across = (
            phase * factor(times, frame) for phase, factor in zip(phases, trajectories, strict=True)
        )
        w[0], w[1], w[2] = across.real, across.imag, spin
        q[0], q[1], q[2], q[3] = alpha.real, beta.real, beta.imag, alpha.imag
        q /= np.sqrt(np.add.reduce(q * q, 0))

    return trajectory
