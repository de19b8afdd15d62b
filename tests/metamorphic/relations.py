"""Ways to report of the same motion in another form, and what becomes of its accelerations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from random_motions import Motion

from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.rotations import (
    conjugate,
    normalize,
    quaternion_product,
    rotation_matrix,
)
from omegadot.reference_impl.system import Acceleration, Array, Body, Load, State, System

StateMap = Callable[[State], State]


@dataclass(frozen=True)
class Retold:
    """The motion in another form.

    state and acceleration: what maps an answer about the first motion to one about this.
    time: what a duration is multiplied by.  drift: m/s, of the new frame.
    """

    motion: Motion
    state: StateMap
    acceleration: Callable[[Acceleration], Acceleration]
    time: float = 1.0
    drift: Array = field(default_factory=lambda: np.zeros(3))


def _along(matrix: Array, vectors: Array) -> Array:
    return np.asarray((matrix @ vectors[..., None])[..., 0])


def _on_pivot(system: System, reported: StateMap) -> StateMap:
    return lambda state: place_on_pivot(system, reported(state))


def rotated_world(motion: Motion, random: np.random.Generator) -> Retold:
    """Another world frame: ``S R``, ``S x``, ``S g``; what is reported in body axes stays."""
    turn = normalize(random.standard_normal(4))
    matrix = rotation_matrix(turn)
    load = replace(
        motion.system.load,
        gravity=_along(matrix, motion.system.load.gravity),
        torque_world=_along(matrix, motion.system.load.torque_world),
    )
    system = replace(motion.system, load=load)

    def reported(state: State) -> State:
        return State(
            normalize(quaternion_product(turn, state.orientation)),
            state.angular_velocity,
            _along(matrix, state.position),
            _along(matrix, state.linear_velocity),
        )

    state = _on_pivot(system, reported)
    return Retold(
        Motion(system, state(motion.states)),
        state,
        lambda a: Acceleration(a.angular, _along(matrix, a.linear)),
    )


def rotated_body(motion: Motion, random: np.random.Generator) -> Retold:
    """Other body axes: ``R P^T``, ``P omega``, ``P I P^T``; what is reported in the world stays."""
    turn = normalize(random.standard_normal(4))
    matrix = rotation_matrix(turn)
    body, load = motion.system.body, motion.system.load
    inertia = matrix @ body.inertia @ matrix.T
    turned = Body(body.mass, _along(matrix, body.center_of_mass), (inertia + inertia.T) / 2.0)
    pivot = None if load.pivot is None else _along(matrix, load.pivot)
    loads = replace(load, pivot=pivot, torque_body=_along(matrix, load.torque_body))
    system = System((turned,), loads)

    def reported(state: State) -> State:
        orientation = normalize(quaternion_product(state.orientation, conjugate(turn)))
        omega = _along(matrix, state.angular_velocity)
        return replace(state, orientation=orientation, angular_velocity=omega)

    state = _on_pivot(system, reported)
    return Retold(
        Motion(system, state(motion.states)),
        state,
        lambda a: Acceleration(_along(matrix, a.angular), a.linear),
    )


def relabelled(motion: Motion, random: np.random.Generator) -> Retold:
    """Axes of world and body named in another order. An odd order is a mirror, in which vectors of
    rotation change their sign: ``det(P) P omega``.
    """
    order = random.permutation(3)
    sign = float(np.linalg.det(np.eye(3)[order]).round())

    def axial(v: Array) -> Array:
        return sign * v[..., order]

    body, load = motion.system.body, motion.system.load
    inertia = body.inertia[np.ix_(order, order)]
    loads = Load(
        gravity=load.gravity[order],
        pivot=None if load.pivot is None else load.pivot[order],
        damping=load.damping,
        torque_body=axial(load.torque_body),
        torque_world=axial(load.torque_world),
    )
    system = System((Body(body.mass, body.center_of_mass[order], inertia),), loads)

    def reported(state: State) -> State:
        q = state.orientation
        return State(
            np.concatenate([q[..., :1], axial(q[..., 1:])], axis=-1),
            axial(state.angular_velocity),
            state.position[..., order],
            state.linear_velocity[..., order],
        )

    state = _on_pivot(system, reported)
    return Retold(
        Motion(system, state(motion.states)),
        state,
        lambda a: Acceleration(axial(a.angular), a.linear[..., order]),
    )


def galilean(motion: Motion, random: np.random.Generator) -> Retold:
    """Another place, and a frame that moves at constant velocity; of free bodies only."""
    speed = float(np.max(np.abs(motion.states.linear_velocity)))
    reach = float(np.max(np.abs(motion.states.position)))
    place, velocity = reach * random.standard_normal(3), speed * random.standard_normal(3)

    def reported(state: State) -> State:
        moved = state.position + place
        return replace(state, position=moved, linear_velocity=state.linear_velocity + velocity)

    return Retold(
        Motion(motion.system, reported(motion.states)), reported, lambda a: a, drift=velocity
    )


def elsewhere(motion: Motion, random: np.random.Generator) -> Retold:
    """Another place; of free bodies only."""
    reach = float(np.max(np.abs(motion.states.position)))
    place = reach * random.standard_normal(3)

    def reported(state: State) -> State:
        return replace(state, position=state.position + place)

    return Retold(Motion(motion.system, reported(motion.states)), reported, lambda a: a)


def scaled_units(motion: Motion, random: np.random.Generator) -> Retold:
    """Units of mass, length and time that are powers of two of the old ones: no digit changes."""
    mass, length, time = (2.0 ** int(n) for n in random.integers(-3, 4, 3))
    body, load = motion.system.body, motion.system.load
    moment = mass * length**2
    loads = Load(
        gravity=load.gravity * length / time**2,
        pivot=None if load.pivot is None else load.pivot * length,
        damping=load.damping * moment / time,
        torque_body=load.torque_body * moment / time**2,
        torque_world=load.torque_world * moment / time**2,
    )
    scaled = Body(body.mass * mass, body.center_of_mass * length, body.inertia * moment)
    system = System((scaled,), loads)

    def reported(state: State) -> State:
        return State(
            state.orientation,
            state.angular_velocity / time,
            state.position * length,
            state.linear_velocity * length / time,
        )

    return Retold(
        Motion(system, reported(motion.states)),
        reported,
        lambda a: Acceleration(a.angular / time**2, a.linear * length / time**2),
        time,
    )


def offset_origin(motion: Motion, random: np.random.Generator) -> Retold:
    """The same body described from another origin: centre of mass and pivot move, nothing else."""
    body, load = motion.system.body, motion.system.load
    size = float(np.sqrt(np.trace(body.inertia) / body.mass))
    shift = size * random.standard_normal(3)
    moved = replace(body, center_of_mass=body.center_of_mass + shift)
    pivot = None if load.pivot is None else load.pivot + shift
    system = System((moved,), replace(load, pivot=pivot))
    state = _on_pivot(system, lambda state: state)
    return Retold(Motion(system, state(motion.states)), state, lambda a: a)


def reversed_time(motion: Motion, _: np.random.Generator) -> Retold:
    """The film run backwards: velocities change their sign, accelerations do not."""

    def reported(state: State) -> State:
        w, v = -state.angular_velocity, -state.linear_velocity
        return replace(state, angular_velocity=w, linear_velocity=v)

    return Retold(Motion(motion.system, reported(motion.states)), reported, lambda a: a)
