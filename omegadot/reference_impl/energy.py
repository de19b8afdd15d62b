"""Kinetic energy, its split (4) and its form (5); potential energy of the weight."""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Array, State, System


def _dot(a: Array, b: Array) -> Array:
    product: Array = np.add.reduce(a * b, -1)
    return product


def linear_kinetic_energy(system: System, state: State) -> Array:
    """``K_v = ½ m ẋᵀẋ``, (...) J. Section 2.3.1."""
    velocity = place_on_pivot(system, state).linear_velocity
    return 0.5 * system.body.mass * _dot(velocity, velocity)


def rotational_kinetic_energy(system: System, state: State) -> Array:
    """``K_ω = ½ ωᵀ I ω``, (...) J, with I about the centre of mass. Equation (5)."""
    w = state.angular_velocity
    return 0.5 * _dot(w, apply(system.body.inertia, w))


def kinetic_energy(system: System, state: State) -> Array:
    """``K_tot = K_ω + K_v``, (...) J. Equation (4)."""
    return rotational_kinetic_energy(system, state) + linear_kinetic_energy(system, state)


def potential_energy(system: System, state: State) -> Array:
    """``-m g · x``, (...) J, zero at the world origin."""
    position = place_on_pivot(system, state).position
    return -system.body.mass * _dot(position, system.load.gravity)


def total_energy(system: System, state: State) -> Array:
    """``K_tot`` and the potential energy of the weight, (...) J.

    Constant in time where there is neither damping nor an applied torque.
    """
    return kinetic_energy(system, state) + potential_energy(system, state)
