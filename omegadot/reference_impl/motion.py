"""The equations of motion: section 3, equations (6) to (9).

Equation (9) is printed without its minus sign. Equation (8) with no torque gives
``ω̇ = -I⁻¹ (ω × I ω)``, and that is what stands here.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.formed_once import formed_once
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.loads import gravity_torque, torque_of
from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array, State, System

AccelerationOf = Callable[[State], Acceleration]
"""Accelerations of states under all loads, the reference's or an engine's, over leading axes."""


def angular_acceleration(inertia: Array, w: Array, torque: Array) -> Array:
    """``ω̇ = I⁻¹ (τ - ω × I ω)``, (..., 3) rad/s², body axes. Equation (8), solved for ω̇."""
    return apply(inverse(inertia), torque - cross(w, apply(inertia, w)))


def torque_free_angular_acceleration(inertia: Array, w: Array) -> Array:
    """``ω̇ = -I⁻¹ (ω × I ω)``, (..., 3) rad/s², body axes. Equation (9), its sign put right."""
    return angular_acceleration(inertia, w, np.zeros_like(w))


def torque_for(inertia: Array, w: Array, w_dot: Array) -> Array:
    """``τ = ω × I ω + I ω̇``, (..., 3) N m, body axes. Equation (8), last line."""
    return cross(w, apply(inertia, w)) + apply(inertia, w_dot)


def center_of_mass_acceleration(system: System, state: State, w_dot: Array) -> Array:
    """``ẍ``, (..., 3) m/s², world.

    A free body's is ``F / m``, equation (7), with the weight as the only force. A pivoted body's
    is the derivative of (3) with the pivot at rest: ``R (ω̇ × r + ω × (ω × r))``.
    """
    w = state.angular_velocity
    if system.load.pivot is None:
        return np.zeros_like(w) + system.load.gravity
    r = lever(system)
    return rotate(state.orientation, cross(w_dot, r) + cross(w, cross(w, r)))


@formed_once
def acceleration_of(system: System) -> AccelerationOf:
    """Forward dynamics of one system as a function of the state, its constants formed once.

    Angular by equation (8), linear by (7) or by the pivot. Schemes step the same in components,
    see `body_motion`.
    """
    inertia = moving_inertia(system)
    inverse_inertia = inverse(inertia)
    torque = torque_of(system)

    def acceleration(state: State) -> Acceleration:
        w = state.angular_velocity
        w_dot = apply(inverse_inertia, torque(state) - cross(w, apply(inertia, w)))
        return Acceleration(w_dot, center_of_mass_acceleration(system, state, w_dot))

    return acceleration


def forward_dynamics(system: System, state: State) -> Acceleration:
    """Accelerations of a state under all loads: ω̇ by (8), ẍ by (7)."""
    return acceleration_of(system)(state)


def inverse_dynamics(system: System, state: State, acceleration: Acceleration) -> Array:
    """The torque (..., 3) N m, body axes, that gives the state this acceleration.

    ``τ = I ω̇ + ω × I ω - τ_gravity``, equation (8) with gravity counted apart, about the centre
    of mass for a free body and about the pivot for a pivoted one.
    """
    needed = torque_for(moving_inertia(system), state.angular_velocity, acceleration.angular)
    return needed - gravity_torque(system, state)
