"""The motion of a free rotation about the axis that the angular velocity encircles.

The sources are named in ``free_rotation.py``.
"""

from __future__ import annotations

from decimal import Decimal

import numpy as np

from omegadot.reference_impl.closed_forms.digits import ONE, ZERO, pi
from omegadot.reference_impl.closed_forms.elliptic import Clock, HyperbolicFrame
from omegadot.reference_impl.closed_forms.euler_poinsot import Constants
from omegadot.reference_impl.closed_forms.phase import Phase
from omegadot.reference_impl.closed_forms.problem import MeasuredRun
from omegadot.reference_impl.closed_forms.shifted_theta import (
    ShiftedTheta,
    theta4_of_double_lattice,
)
from omegadot.reference_impl.closed_forms.theta import jacobi_rows, scaled
from omegadot.reference_impl.closed_forms.theta_series import Series
from omegadot.reference_impl.closed_forms.times import Times
from omegadot.reference_impl.system import Array


def mean_rate(c: Constants, theta: ShiftedTheta) -> Decimal:
    """Mean rate, rad/s, of the angle ψ about the momentum.

    ``dψ/dt = L / I_c ± rate G``, ``G = √((1-κ²)(1-m1 κ²)) / (κ (1 + κ dn u))``. G has the residues
    ``±i`` of ``-2 d arg Θ / du`` at its poles ``dn u = -1/κ``, from which it differs by a constant.
    """
    kappa = c.inertia[2] * c.amplitude[2] / c.momentum
    root = (c.complement * (c.complement + c.modulus.m * kappa**2)).sqrt()
    constant = root / (kappa * (ONE + kappa)) + 2 * (theta.slope - theta.gain)
    return c.momentum / c.inertia[2] + c.turn * c.rate * constant


def encircling_theta(c: Constants) -> ShiftedTheta:
    """The theta function of the attitude: its zeros are the points where ``dn u = -1/κ``.

    With ``dn u = -1/κ`` at ``i (K' + d)``: ``sn(d, m1) = κ``, so ``d = κ R_F(1-κ², 1-m1 κ², 1)``.
    """
    kappa = c.inertia[2] * c.amplitude[2] / c.momentum
    complementary = c.complement + c.modulus.m * kappa**2
    return theta4_of_double_lattice(
        c.modulus, c.modulus.argument(kappa, c.complement, complementary)
    )


def motion_of(c: Constants) -> MeasuredRun:
    """The direction of the momentum and the attitude, both in the frame with the axes c, a, b.

    With the Cayley-Klein parameters ``α = q_0 + i q_c``, ``β = q_a + i q_b`` of the shortest
    rotation that takes the momentum h to axis c, times the one by ψ about h,

        |α|² = (1 + h_c) / 2 = C² |Θ|² / θ4,  β = α (h_b - i h_a) / (1 + h_c),

    and ``arg α = ψ/2``: where c has the greatest inertia ``α = C exp(iμt) Θ*/√θ4``, else it has Θ.
    """
    theta = encircling_theta(c)
    clock = Clock.of(c.modulus, c.rate, c.start)
    angle = Phase.of(mean_rate(c, theta) / (4 * pi()), ZERO)
    h_b, h_a, h_c = (c.inertia[i] * c.amplitude[i] / c.momentum for i in (1, 0, 2))
    size = ((ONE + h_c) / 2).sqrt() / theta.start
    series = Series.of(
        [
            *jacobi_rows(c.modulus, h_b, h_a, h_c),
            scaled(theta.real, size),
            scaled(theta.imaginary, -c.turn * size),
        ]
    )
    skew = c.turn * theta.skew
    if series.constant and abs(h_a) == abs(h_b):
        return _symmetric_motion(clock, angle, series.matrix[:, 0].tolist())

    def trajectory(times: Times, h: Array, q: Array) -> None:
        frame = clock.read(times)
        more = skew * frame.turn if isinstance(frame, HyperbolicFrame) else None
        spin = angle.circle(times, more)
        b, a, c, divisor, real, imaginary = series(frame)
        odd, even, both = frame.odd_even
        b *= odd
        a *= even
        imaginary *= both
        np.divide(c, divisor, out=h[0])
        np.divide(a, divisor, out=h[1])
        np.divide(b, divisor, out=h[2])
        c += divisor
        np.sqrt(divisor, out=divisor)
        factor = np.empty(spin.shape, complex)
        np.divide(real, divisor, out=factor.real)
        np.divide(imaginary, divisor, out=factor.imag)
        spin *= factor
        np.divide(b, c, out=factor.real)
        np.divide(a, np.negative(c, out=c), out=factor.imag)
        factor *= spin
        _store(q, spin, factor)

    return trajectory


def _symmetric_motion(clock: Clock, angle: Phase, constants: list[float]) -> MeasuredRun:
    """The same where two moments agree: the Jacobi functions are circular, Θ and θ4 are one."""
    b, a, c, _, size, _ = constants
    ratio = np.array(-1j * a / (1.0 + c) * size)

    def trajectory(times: Times, h: Array, q: Array) -> None:
        circle = clock.phase.circle(times)
        spin = angle.circle(times)
        h[0] = c
        np.multiply(circle.real, a, out=h[1])
        np.multiply(circle.imag, b, out=h[2])
        if b < 0:
            np.conjugate(circle, out=circle)
        circle *= spin
        circle *= ratio
        spin *= size
        _store(q, spin, circle)

    return trajectory


def _store(q: Array, alpha: Array, beta: Array) -> None:
    """The quaternion's rows (q_0, q_c, q_a, q_b) as pairs of real numbers."""
    pairs = q.T.view(complex)
    pairs[:, 0] = alpha
    pairs[:, 1] = beta
