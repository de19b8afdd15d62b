"""The torque of inverse dynamics by another inertia, acceleration or gyroscopic term."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever, moving_inertia, parallel_axis
from omegadot.reference_impl.loads import gravity_torque
from omegadot.reference_impl.motion import forward_dynamics, inverse_dynamics
from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array, State, System


def other_gyroscopic(inertia: Array, w: Array, rate: Array) -> Iterator[tuple[str, Array]]:
    """With omega-dot in the place of an omega."""
    yield "omega-dot x I omega", np.asarray(cross(rate, apply(inertia, w)))
    yield "omega x I omega-dot", np.asarray(cross(w, apply(inertia, rate)))


def other_bodies(
    system: System, states: State, requested: Acceleration
) -> dict[str, Callable[[], Array]]:
    """The torque by another inertia."""
    inertia, w = np.asarray(moving_inertia(system), dtype=float), states.angular_velocity
    gravity, body = gravity_torque(system, states), system.body.inertia
    diagonal = np.diag(np.diag(inertia))
    about_origin = np.asarray(body) + parallel_axis(
        float(system.body.mass), np.asarray(system.body.center_of_mass)
    )

    def by(mass: Array, spin: Array) -> Callable[[], Array]:
        return lambda: apply(mass, requested.angular) + cross(w, apply(spin, w)) - gravity

    return {
        "inverse dynamics use the inertia's diagonal alone": by(diagonal, diagonal),
        "inverse dynamics use the inertia's diagonal alone for omega-dot": by(diagonal, inertia),
        "inverse dynamics use the inertia's diagonal alone in the gyroscopic term": by(
            inertia, diagonal
        ),
        "inverse dynamics use the inertia about the centre of mass, not about the pivot": by(
            np.asarray(body), np.asarray(body)
        ),
        "inverse dynamics take the body for a free one: with the inertia about its centre of mass, "
        "without gravity": lambda: (
            apply(np.asarray(body), requested.angular) + cross(w, apply(np.asarray(body), w))
        ),
        "inverse dynamics use the inertia about the body's origin": by(about_origin, about_origin),
        "inverse dynamics have the products of inertia with the wrong sign": by(
            2.0 * diagonal - inertia, 2.0 * diagonal - inertia
        ),
        **_other_acceleration(system, states, requested),
        "inverse dynamics invert the inertia": by(np.asarray(inverse(inertia)), inertia),
        "inverse dynamics give the torque of the acceleration that the loads cause": lambda: (
            inverse_dynamics(system, states, forward_dynamics(system, states))
        ),
    }


def _other_acceleration(
    system: System, states: State, requested: Acceleration
) -> dict[str, Callable[[], Array]]:
    """The sum of what turns the body and of ``r x m (a - g)``, with another acceleration a.

    One that lacks a part is another inertia in a term of the torque about the pivot.
    """
    arm, w, q = lever(system), states.angular_velocity, states.orientation
    tangential, inward = cross(requested.angular, arm), cross(w, cross(w, arm))
    mass = float(system.body.mass)

    def by(other: Array) -> Callable[[], Array]:
        more = cross(arm, mass * (other - tangential - inward))
        return lambda: inverse_dynamics(system, states, requested) + more

    if system.load.pivot is None:
        return {}
    of = "inverse dynamics have the acceleration of the centre of mass"
    return {
        f"{of} in world axes, in place of body axes": by(rotate(q, tangential + inward)),
        f"{of} with the wrong sign": by(-tangential - inward),
    }
