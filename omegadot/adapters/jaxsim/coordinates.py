"""The project's states and JaxSim's coordinates: rows of (p, q, v, ω), (..., 13).

p and v are position and velocity of the body's origin, q is (w, x, y, z), world-from-body, and ω
is in world axes: JaxSim's mixed representation. Its gravity is along z, so its world is the
project's, turned by the shortest way that puts gravity there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.kinematics import at_point
from omegadot.reference_impl.rotations import (
    conjugate,
    normalize,
    quaternion_product,
    rotate,
    rotate_inverse,
)
from omegadot.reference_impl.system import Acceleration, Array, State

DOWN = 2  # the axis along which JaxSim has gravity


@dataclass(frozen=True)
class Coordinates:
    """center: (3,) m, from the body's origin to the centre of mass, body axes.

    turn: the quaternion that turns the project's world axes to JaxSim's.  gravity: along z there.
    """

    center: Array
    turn: Array
    gravity: float

    def of_state(self, state: State) -> Array:
        """The row: ``p = x - R c`` and, by equation (3), ``v = ẋ - R (ω × c)``, turned."""
        origin = at_point(state, -self.center)
        q = self._turned_attitude(state.orientation)
        parts = (
            rotate(self.turn, origin.position),
            q,
            rotate(self.turn, origin.linear_velocity),
            rotate(q, state.angular_velocity),
        )
        return np.concatenate(parts, axis=-1)

    def to_state(self, rows: Array) -> State:
        """The states of rows."""
        p, q, v, w = np.split(rows, (3, 7, 10), axis=-1)
        origin = State(
            orientation=quaternion_product(conjugate(self.turn), normalize(q)),
            angular_velocity=rotate_inverse(normalize(q), w),
            position=rotate_inverse(self.turn, p),
            linear_velocity=rotate_inverse(self.turn, v),
        )
        return at_point(origin, self.center)

    def _turned_attitude(self, orientation: Array) -> Array:
        return quaternion_product(self.turn, orientation)

    def _lift(self, states: State, w_dot: Array) -> Array:
        """``R (ω̇ × c + ω × (ω × c))``: the centre of mass's acceleration above the origin's."""
        w, c = states.angular_velocity, self.center
        return rotate(states.orientation, cross(w_dot, c) + cross(w, cross(w, c)))

    def of_acceleration(self, states: State, acceleration: Acceleration) -> Array:
        """Accelerations (..., 6): that of the origin, and ω̇ in JaxSim's world axes."""
        w_dot = acceleration.angular
        origin = acceleration.linear - self._lift(states, w_dot)
        q = self._turned_attitude(states.orientation)
        return np.concatenate((rotate(self.turn, origin), rotate(q, w_dot)), axis=-1)

    def to_acceleration(self, states: State, found: Array) -> Acceleration:
        """ω̇ in body axes and the centre of mass's acceleration in world axes."""
        q = self._turned_attitude(states.orientation)
        w_dot = rotate_inverse(q, found[..., 3:])
        origin = rotate_inverse(self.turn, found[..., :3])
        return Acceleration(angular=w_dot, linear=origin + self._lift(states, w_dot))

    def to_torque(self, states: State, found: Array) -> Array:
        """Torque in body axes about the centre of mass, of a force and a torque at the origin."""
        q = self._turned_attitude(states.orientation)
        force, torque = (rotate_inverse(q, part) for part in np.split(found, 2, axis=-1))
        about_center: Array = torque - cross(self.center, force)
        return about_center

    def to_world(self, vector: Array) -> Array:
        """A vector in the project's world axes, in JaxSim's."""
        return rotate(self.turn, vector)


def coordinates_of(center: Array, gravity: Array) -> Coordinates:
    """Those of a body in this gravity, (3,) m/s^2.

    The turn from unit vector a to b is by ``(1 + a·b, a × b)``, of which neither vanishes here:
    gravity goes to the nearer of both ends of z.
    """
    size = float(np.linalg.norm(gravity))
    sign = -1.0 if gravity[DOWN] < 0.0 else 1.0
    if size == 0.0:
        return Coordinates(center, np.array([1.0, 0.0, 0.0, 0.0]), 0.0)
    along, end = gravity / size, sign * np.eye(3)[DOWN]
    turn = normalize(np.append(1.0 + along @ end, cross(along, end)))
    return Coordinates(center, turn, sign * size)
