"""Free rotation of any rigid body: the angular velocity of Euler, the attitude of Poinsot.

Sources. Angular velocity: Landau and Lifshitz, Mechanics, section 37, (37.8)-(37.12). Attitude:
Celledoni, Fassò, Säfström and Zanna, The exact computation of the free rigid body motion and its
use in splitting methods, SIAM J. Sci. Comput. 30 (2008) 2084-2112: a rotation about the angular
momentum times the shortest rotation that takes the momentum to the encircled axis. The angle goes
by theta functions, as with Jacobi; van Zon and Schofield, Numerical implementation of the exact
dynamics of free rigid bodies, J. Comput. Phys. 225 (2007) 145-164, do the like.
Errata. The authors of Orekit (class TorqueFree) found (37.17)-(37.20) of Landau and Lifshitz to be
wrong; those of Principia (euler_solver.hpp) found wrong signs of λ in cases (i) and (ii), and a
wrong σ in case (iii), of Proposition 2.1 of Celledoni et al. Neither is used here: the angle is
derived from ``dψ/dt = (2T + L ω_c) / (L + I_c ω_c)``.
"""

from __future__ import annotations

from decimal import Decimal

import numpy as np

from omegadot.reference_impl.closed_forms.digits import (
    ONE,
    ZERO,
    Matrix,
    Row,
    dot,
    doubles,
    exact,
    exact_matrix,
    many_digits,
    pi,
)
from omegadot.reference_impl.closed_forms.elliptic import Clock
from omegadot.reference_impl.closed_forms.euler_poinsot import Constants, constants_of
from omegadot.reference_impl.closed_forms.phase import Phase, Times, unit_circle
from omegadot.reference_impl.closed_forms.problem import (
    IDENTITY,
    UPRIGHT,
    Course,
    Motion,
    Problem,
    inertia_about,
    lever_of,
    place,
    quaternion_of,
)
from omegadot.reference_impl.closed_forms.shifted_theta import (
    ShiftedTheta,
    theta4_of_double_lattice,
)
from omegadot.reference_impl.closed_forms.theta import jacobi
from omegadot.reference_impl.system import Array, State, System


def free_rotation_of(system: System, initial: State) -> Problem | None:
    """The free rotation of the system, or None where a torque acts.

    Free are bodies in any gravity, and pivoted ones without gravity or held at their centre of
    mass; damping and applied torques must be zero. Their numbers: the lower triangle of the inertia
    about the point that matters (6), angular velocity (3), orientation (4).
    """
    body, load = system.body, system.load
    if np.any(load.damping) or np.any(load.torque_body) or np.any(load.torque_world):
        return None
    with many_digits():
        lever = lever_of(body, load)
        if any(lever) and np.any(load.gravity):
            return None
        about = inertia_about(exact_matrix(body.inertia), exact(body.mass), lever)
        triangle = [(about[i][j] + about[j][i]) / 2 for i in range(3) for j in range(i + 1)]
        numbers = triangle + exact(initial.angular_velocity) + exact(initial.orientation)
    return Problem("free rotation", numbers, _solve)


def _solve(numbers: Row) -> Motion:
    with many_digits():
        orientation = numbers[9:]
        constants = constants_of(*inertia_and_omega(numbers))
        if constants is None:
            return place(uniform(numbers[6:9]), IDENTITY, UPRIGHT, orientation)
        scales = [constants.momentum / moment for moment in constants.inertia]
        turning = [[s * x for x in row] for s, row in zip(scales, constants.axes, strict=True)]
        return place(_course(constants), turning, quaternion_of(constants.axes), orientation)


def inertia_and_omega(numbers: Row) -> tuple[Matrix, Row]:
    """The inertia (3, 3) and the angular velocity (3,) among a free rotation's numbers."""
    a, b, c, d, e, f = numbers[:6]
    return [[a, b, d], [b, c, e], [d, e, f]], numbers[6:9]


def uniform(omega: Row) -> Course:
    """ω constant: ``q = (cos |ω|t/2, sin |ω|t/2 ω/|ω|)``, the vector of the course is ω."""
    speed = dot(omega, omega).sqrt()
    angle = Phase.of(speed / (4 * pi()), ZERO)
    direction = doubles([x / speed for x in omega] if speed else omega)[:, None]
    w = doubles(omega)[:, None]

    def course(times: Times, vector: Array, q: Array) -> None:
        circle = unit_circle(angle.modulo(times))
        q[0] = circle.real
        np.multiply(circle.imag, direction, out=q[1:])
        vector[:] = w

    return course


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


def _course(c: Constants) -> Course:
    """The direction of the momentum and the attitude, both in the frame of the constants."""
    theta = encircling_theta(c)
    clock = Clock.of(c.modulus, c.rate, c.start)
    angle = Phase.of(mean_rate(c, theta) / (4 * pi()), ZERO)
    functions = jacobi(c.modulus, *[c.inertia[i] * c.amplitude[i] / c.momentum for i in (1, 0, 2)])
    skew, opposite = c.turn * theta.skew, c.turn < 0

    def course(times: Times, h: Array, q: Array) -> None:
        frame = clock.read(times)
        h_b, h_a, h_c = functions(frame)
        turns = angle.modulo(times)
        if skew:
            turns += skew * frame.turn
        spin = unit_circle(turns)
        value = theta.value(frame)
        # exp(iψ/2) is exp(2πi turns) Θ*/|Θ| where c has the greatest inertia, else it has Θ
        spin *= value if opposite else np.conjugate(value, out=value)
        h[0], h[1], h[2] = h_a, h_b, h_c
        h_c += 1.0
        scale = value.real * value.real
        scale += value.imag * value.imag
        scale *= h_c
        np.divide(0.5, scale, out=scale)
        np.sqrt(scale, out=scale)
        c0, c3 = scale * spin.real, scale * spin.imag
        np.multiply(c0, h_c, out=q[0])
        np.multiply(c3, h_c, out=q[3])
        np.multiply(c0, h_b, out=q[1])
        q[1] += c3 * h_a
        np.multiply(c3, h_b, out=q[2])
        q[2] -= c0 * h_a

    return course
