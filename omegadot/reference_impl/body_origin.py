"""The same motion, told at the body's origin instead of the centre of mass.

An engine that keeps the origin's position and velocity steps those. With the centre of mass off
the origin its scheme then errs in the momentum of translation, though the scheme is the same.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.kinematics import point_position, point_velocity
from omegadot.reference_impl.motion import acceleration_of
from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.schemes import AccelerationOf
from omegadot.reference_impl.system import Acceleration, State, System


def is_offset(system: System) -> bool:
    """Whether a free body's centre of mass lies off its origin."""
    return system.load.pivot is None and bool(np.any(system.body.center_of_mass))


def to_origin(system: System, state: State) -> State:
    """Position and velocity of the origin, ``x - R c`` and ``v - R (ω × c)`` by equation (3)."""
    back = -system.body.center_of_mass
    return replace(
        state,
        position=point_position(state, back),
        linear_velocity=point_velocity(state, back),
    )


def from_origin(system: System, state: State) -> State:
    """The inverse of `to_origin`."""
    c = system.body.center_of_mass
    return replace(
        state, position=point_position(state, c), linear_velocity=point_velocity(state, c)
    )


def origin_acceleration_of(system: System) -> AccelerationOf:
    """Accelerations of a state told at the origin: ``a - R (ω̇ × c + ω × (ω × c))``.

    The loads must not depend on the place, as gravity and torques here do not.
    """
    of_center, c = acceleration_of(system), system.body.center_of_mass

    def acceleration(state: State) -> Acceleration:
        found, w = of_center(state), state.angular_velocity
        lever = cross(found.angular, c) + cross(w, cross(w, c))
        return Acceleration(found.angular, found.linear - rotate(state.orientation, lever))

    return acceleration
