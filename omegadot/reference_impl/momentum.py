"""Momenta, the gradients of the kinetic energy by the velocities: sections 2.3 and 3."""

from __future__ import annotations

from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Array, State, System


def linear_momentum(system: System, state: State) -> Array:
    """``m ẋ``, (..., 3) kg m/s, world: the gradient of K_v, section 2.3.1."""
    velocity = place_on_pivot(system, state).linear_velocity
    return system.body.mass[..., None] * velocity


def angular_momentum(system: System, state: State) -> Array:
    """``R I ω``, (..., 3) kg m²/s, world: the gradient of K_ω of (5), turned into the world.

    About the centre of mass for a free body, about the pivot for a pivoted one.
    """
    return rotate(state.orientation, apply(moving_inertia(system), state.angular_velocity))
