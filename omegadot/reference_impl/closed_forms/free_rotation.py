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

from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal
from typing import TypeAlias

import numpy as np

from omegadot.reference_impl.closed_forms.digits import (
    ONE,
    ZERO,
    Matrix,
    Row,
    dot,
    doubles,
    many_digits,
    pi,
)
from omegadot.reference_impl.closed_forms.elliptic import Clock
from omegadot.reference_impl.closed_forms.euler_poinsot import Constants, constants_of
from omegadot.reference_impl.closed_forms.phase import Phase, Times, unit_circle
from omegadot.reference_impl.closed_forms.shifted_theta import (
    ShiftedTheta,
    theta4_of_double_lattice,
)
from omegadot.reference_impl.closed_forms.theta import jacobi
from omegadot.reference_impl.rotations import conjugate, normalize, quaternion_product
from omegadot.reference_impl.system import Array

# Times to the direction of the momentum (3, n) and the attitude (4, n), both in the frame of the
# constants; a uniform rotation gives ω in place of the direction.
Course: TypeAlias = Callable[[Times], tuple[Array, Array]]

_CHUNK = 8192  # times worked at once, so that intermediate arrays stay in the cache


@dataclass(frozen=True)
class FreeRotation:
    """A free rotation ready to be read at any times, before and after zero.

    constants: None for a uniform rotation.  course: the motion in the frame of the constants.
    scaled_axes: (3, 3), the linear map from the course's first vector to ω in body axes.  placing: (4, 4), the linear map from the
    frame's quaternion to the attitude (world-from-frame before it, frame-from-body after it).
    """

    constants: Constants | None
    course: Course
    scaled_axes: Array
    placing: Array

    def at(self, times: Array) -> tuple[Array, Array]:
        """Attitude (n, 4) and angular velocity (n, 3) rad/s, body frame, at times (n,) s."""
        orientation = np.empty((times.size, 4))
        angular_velocity = np.empty((times.size, 3))
        for first in range(0, times.size, _CHUNK):
            part = slice(first, first + _CHUNK)
            w, q = self.course(Times.of(times[part]))
            np.matmul(w.T, self.scaled_axes, out=angular_velocity[part])
            np.matmul(q.T, self.placing, out=orientation[part])
        return orientation, angular_velocity


def free_rotation(inertia: Matrix, omega: Row, orientation: Array) -> FreeRotation:
    """The rotation that starts at ``omega`` (3,) rad/s and ``orientation`` (4,) at time zero.

    inertia: about the centre of mass or a fixed point, body axes, kg m^2.
    """
    with many_digits():
        constants = constants_of(inertia, omega)
        if constants is None:
            axes = np.eye(3)
            course = _uniform(omega)
            frame = np.array([1.0, 0.0, 0.0, 0.0])
        else:
            scales = [constants.momentum / moment for moment in constants.inertia]
            axes = np.array(
                [
                    doubles([s * x for x in row])
                    for s, row in zip(scales, constants.axes, strict=True)
                ]
            )
            course = _course(constants)
            frame = doubles(quaternion_of(constants.axes))
    _, q = course(Times.of(np.zeros(1)))
    body = quaternion_product(q[:, 0], frame)
    world = quaternion_product(normalize(orientation), conjugate(body))
    basis = np.eye(4)
    placing = quaternion_product(quaternion_product(world, basis), frame)
    return FreeRotation(constants, course, axes, placing)


def _uniform(omega: Row) -> Course:
    """ω constant: ``q = (cos |ω|t/2, sin |ω|t/2 ω/|ω|)``."""
    speed = dot(omega, omega).sqrt()
    angle = Phase.of(speed / (4 * pi()), ZERO)
    direction = doubles([x / speed for x in omega] if speed else omega)[:, None]
    w = doubles(omega)[:, None]

    def course(times: Times) -> tuple[Array, Array]:
        circle = unit_circle(angle.reduced(times)[1])
        q = np.empty((4, times.value.size))
        q[0] = circle.real
        q[1:] = circle.imag * direction
        return w + np.zeros((3, times.value.size)), q

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
    theta = encircling_theta(c)
    clock = Clock.of(c.modulus, c.rate, c.start)
    angle = Phase.of(mean_rate(c, theta) / (4 * pi()), ZERO)
    # the direction of the momentum in the frame: h = I ω / L
    functions = jacobi(c.modulus, *[c.inertia[i] * c.amplitude[i] / c.momentum for i in (1, 0, 2)])
    skew, opposite = c.turn * theta.skew, c.turn < 0

    def course(times: Times) -> tuple[Array, Array]:
        frame = clock.read(times)
        h_b, h_a, h_c = functions(frame)
        turns = angle.reduced(times)[1]
        turns += skew * frame.turn
        spin = unit_circle(turns)
        value = theta.value(frame)
        # exp(iψ/2) is exp(2πi turns) Θ*/|Θ| where c has the greatest inertia, else it has Θ
        spin *= value if opposite else np.conjugate(value, out=value)
        h = np.empty((3, times.value.size))
        h[0], h[1], h[2] = h_a, h_b, h_c
        h_c += 1.0
        scale = value.real * value.real
        scale += value.imag * value.imag
        scale *= h_c
        np.divide(0.5, scale, out=scale)
        np.sqrt(scale, out=scale)
        c0, c3 = scale * spin.real, scale * spin.imag
        q = np.empty((4, times.value.size))
        np.multiply(c0, h_c, out=q[0])
        np.multiply(c3, h_c, out=q[3])
        np.multiply(c0, h_b, out=q[1])
        q[1] += c3 * h_a
        np.multiply(c3, h_b, out=q[2])
        q[2] -= c0 * h_a
        return h, q

    return course


def quaternion_of(axes: Matrix) -> Row:
    """The quaternion of the rotation whose matrix has these rows: frame-from-body.

    The greatest of the four components is found first, the rest by division (Shepperd 1978).
    """
    m = axes
    squares = [ONE + sum(s * m[i][i] for i, s in enumerate(signs)) for signs in _SIGNS]
    products = [
        [squares[0], m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]],
        [m[2][1] - m[1][2], squares[1], m[0][1] + m[1][0], m[0][2] + m[2][0]],
        [m[0][2] - m[2][0], m[0][1] + m[1][0], squares[2], m[1][2] + m[2][1]],
        [m[1][0] - m[0][1], m[0][2] + m[2][0], m[1][2] + m[2][1], squares[3]],
    ]
    greatest = max(range(4), key=lambda i: squares[i])
    row = products[greatest]
    size = dot(row, row).sqrt()
    return [x / size for x in row]


_SIGNS = ((1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1))
