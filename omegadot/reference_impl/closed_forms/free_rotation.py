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

import numpy as np

from omegadot.reference_impl.closed_forms.digits import (
    ZERO,
    Matrix,
    Row,
    dot,
    doubles,
    fewer_digits,
    many_digits,
    pi,
)
from omegadot.reference_impl.closed_forms.euler_poinsot import constants_of
from omegadot.reference_impl.closed_forms.free_rotation_motion import motion_of
from omegadot.reference_impl.closed_forms.given import Given
from omegadot.reference_impl.closed_forms.phase import Phase
from omegadot.reference_impl.closed_forms.problem import (
    MeasuredRun,
    Motion,
    Problem,
    place,
    quaternion_of,
)
from omegadot.reference_impl.closed_forms.times import Times
from omegadot.reference_impl.system import Array


def free_rotation_of(given: Given) -> Problem | None:
    """The free rotation, or None where a torque acts.

    Free are bodies in any gravity, and pivoted ones without gravity or held at their centre of
    mass; damping and applied torques must be zero. Their numbers: the lower triangle of the inertia
    about the point that matters (6), angular velocity (3), orientation (4).
    """
    if given.hangs or given.driven or given.damping:
        return None
    about = given.inertia
    triangle = [(about[i][j] + about[j][i]) / 2 for i in range(3) for j in range(i + 1)]
    return Problem("free rotation", triangle + given.omega + given.orientation, _solve)


def _solve(numbers: Row) -> Motion:
    with many_digits():
        orientation = numbers[9:]
        constants = constants_of(*inertia_and_omega(numbers))
        if constants is None:
            return place(uniform(numbers[6:9]), orientation)
    with fewer_digits():
        order = (2, 0, 1)  # c, a, b
        axes = [constants.axes[i] for i in order]
        scales = [constants.momentum / constants.inertia[i] for i in order]
        turning = [[s * x for x in row] for s, row in zip(scales, axes, strict=True)]
        return place(motion_of(constants), orientation, turning, quaternion_of(axes))


def inertia_and_omega(numbers: Row) -> tuple[Matrix, Row]:
    """The inertia (3, 3) and the angular velocity (3,) among a free rotation's numbers."""
    a, b, c, d, e, f = numbers[:6]
    return [[a, b, d], [b, c, e], [d, e, f]], numbers[6:9]


def uniform(omega: Row) -> MeasuredRun:
    """ω constant: ``q = (cos |ω|t/2, sin |ω|t/2 ω/|ω|)``, the vector of the motion is ω."""
    speed = dot(omega, omega).sqrt()
    angle = Phase.of(speed / (4 * pi()), ZERO)
    direction = doubles([x / speed for x in omega] if speed else omega)[:, None]
    w = doubles(omega)[:, None]

    def trajectory(times: Times, vector: Array, q: Array) -> None:
        circle = angle.circle(times)
        q[0] = circle.real
        np.multiply(circle.imag, direction, out=q[1:])
        vector[:] = w

    return trajectory
