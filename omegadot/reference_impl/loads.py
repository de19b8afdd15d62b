"""Forces and torques on the body: the F of equation (7) and the tau of equation (8)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.formed_once import formed_once
from omegadot.reference_impl.inertia import lever
from omegadot.reference_impl.rotations import rotate_inverse
from omegadot.reference_impl.system import Array, State, System


@formed_once
def weight(system: System) -> Array:
    """``m g``, (..., 3) N, world axes, acting at the centre of mass."""
    return system.body.mass[..., None] * system.load.gravity


def gravity_torque(system: System, state: State) -> Array:
    """``r × R^T m g``, (..., 3) N m, body axes, r from the pivot to the centre of mass.

    Zero for a free body: gravity has no moment about the centre of mass.
    """
    if system.load.pivot is None:
        return np.zeros_like(state.angular_velocity)
    return cross(lever(system), rotate_inverse(state.orientation, weight(system)))


def damping_torque(system: System, state: State) -> Array:
    """``-d ω``, (..., 3) N m, body axes."""
    return -system.load.damping[..., None] * state.angular_velocity


def applied_torque(system: System, state: State) -> Array:
    """The constant torques, ``τ_body + R^T τ_world``, (..., 3) N m, body axes."""
    return system.load.torque_body + rotate_inverse(state.orientation, system.load.torque_world)


def torque_of(system: System) -> Callable[[State], Array]:
    """The tau of equation (8) as a function of the state, (..., 3) N m, body axes.

    Gravity, damping and applied torques together, about the centre of mass for a free body, about
    the pivot for a pivoted one. Loads that are zero are left out once, here, and not at each step.
    """
    load = system.load
    acting: list[Callable[[System, State], Array]] = []
    if np.any(load.damping):
        acting.append(damping_torque)
    if np.any(load.torque_body) or np.any(load.torque_world):
        acting.append(applied_torque)
    if load.pivot is not None and np.any(load.gravity):
        acting.append(gravity_torque)

    def torque(state: State) -> Array:
        w = state.angular_velocity
        total = np.zeros_like(w)
        for part in acting:
            total = total + part(system, state)
        return total

    return torque


def torque(system: System, state: State) -> Array:
    """The tau of equation (8) at a state, all loads together: see `torque_of`."""
    return torque_of(system)(state)
