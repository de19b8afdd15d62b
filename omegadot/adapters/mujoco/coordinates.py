"""The project's states and MuJoCo's coordinates: rows of (qpos, qvel, qacc).

A free joint keeps the position and velocity of the body's origin in world axes and the angular
velocity in body axes: qpos = (p, q), qvel = (v, ω). A ball joint keeps q and ω alone. Quaternions
are (w, x, y, z), world-from-body, as here.
"""

from dataclasses import dataclass

import numpy as np

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.system import Acceleration, Array, State


@dataclass(frozen=True)
class Coordinates:
    """arm: (3,) m, from the body's origin, or from the pivot, to the centre of mass, body axes."""

    arm: Array
    pivoted: bool

    def of_state(self, state: State) -> tuple[Array, Array]:
        """The coordinates: ``p = x - R r`` and, by equation (3), ``v = ẋ - R (ω × r)``."""
        q, w = state.orientation, state.angular_velocity
        if self.pivoted:
            return q, w
        origin = state.position - rotate(q, self.arm)
        velocity = state.linear_velocity - rotate(q, cross(w, self.arm))
        return np.concatenate([origin, q], axis=-1), np.concatenate([velocity, w], axis=-1)

    def to_state(self, qpos: Array, qvel: Array) -> State:
        """The state of qpos and qvel; the pivot stands at the world's origin."""
        q, w = qpos[..., -4:].copy(), qvel[..., -3:].copy()
        origin, velocity = (0.0, 0.0) if self.pivoted else (qpos[..., :3], qvel[..., :3])
        return State(
            orientation=q,
            angular_velocity=w,
            position=origin + rotate(q, self.arm),
            linear_velocity=velocity + rotate(q, cross(w, self.arm)),
        )

    def _lift(self, states: State, w_dot: Array) -> Array:
        """``R (ω̇ × r + ω × (ω × r))``: the centre of mass's acceleration above the origin's."""
        w = states.angular_velocity
        return rotate(states.orientation, cross(w_dot, self.arm) + cross(w, cross(w, self.arm)))

    def of_acceleration(self, states: State, acceleration: Acceleration) -> Array:
        """The derivative of qvel, qacc."""
        w_dot = acceleration.angular
        if self.pivoted:
            return w_dot
        origin = acceleration.linear - self._lift(states, w_dot)
        return np.concatenate([origin, w_dot], axis=-1)

    def to_acceleration(self, states: State, qacc: Array) -> Acceleration:
        """ω̇ in body axes and the centre of mass's acceleration in world axes."""
        w_dot = qacc[..., -3:].copy()
        origin = 0.0 if self.pivoted else qacc[..., :3]
        return Acceleration(angular=w_dot, linear=origin + self._lift(states, w_dot))

    def to_torque(self, states: State, qfrc: Array) -> Array:
        """Torque in body axes about the centre of mass, or the pivot, of generalised forces.

        A free joint's last three act about the body's origin: ``τ = τ_o - r × Rᵀ F``.
        """
        torque = qfrc[..., -3:].copy()
        if self.pivoted:
            return torque
        force = rotate_inverse(states.orientation, qfrc[..., :3])
        about_center: Array = torque - cross(self.arm, force)
        return about_center
