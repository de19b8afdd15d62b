"""States of a Drake body in the project's frames, and its dynamics.

A plant's velocities are (angular, linear) in world axes, of the body's frame; a ball joint's are
the angular ones alone. A free body's positions are (w, x, y, z) and the frame's place, a ball
joint's are roll, pitch and yaw: ``R = Rz(yaw) Ry(pitch) Rx(roll)``.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.drake.model import DrakeModel
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.kinematics import at_point, place_on_pivot
from omegadot.reference_impl.rotations import (
    normalize,
    quaternion_product,
    rotate,
    rotate_inverse,
)
from omegadot.reference_impl.system import Acceleration, Array, Body, State


class DrakeJoint:
    """The body of a continuous `DrakeModel`."""

    def __init__(self, drake: Any, model: DrakeModel) -> None:
        self._drake, self.model = drake, model
        self._plant, self._node = model.plant, model.node
        self._center = np.array(model.system.body.center_of_mass, float)
        self._context, self._own = model.context()

    def body(self) -> Body:
        """Mass, centre of mass and inertia, read back."""
        return self.model.body(self._own)

    def coordinates(self, state: State) -> Array:
        """Positions and velocities of the plant in one vector, (13,) or (6,)."""
        q, w = np.array(state.orientation, float), state.angular_velocity
        spin = rotate(q, w)
        if not self.model.free:
            attitude = self._drake.Quaternion(normalize(q))
            return np.concatenate((self._drake.RollPitchYaw(attitude).vector(), spin))
        at_origin = at_point(state, -self._center)
        return np.concatenate((q, at_origin.position, spin, at_origin.linear_velocity))

    def states(self, rows: Array) -> State:
        """The states of such vectors (n, 13) or (n, 6)."""
        if not self.model.free:
            q, nowhere = quaternions_of(rows[:, :3]), np.zeros((len(rows), 3))
            spin = rotate_inverse(q, rows[:, 3:])
            return place_on_pivot(self.model.system, State(q, spin, nowhere, nowhere))
        q = normalize(rows[:, :4])
        state = State(q, rotate_inverse(q, rows[:, 7:10]), rows[:, 4:7], rows[:, 10:])
        return at_point(state, self._center)

    def set_state(self, state: State) -> None:
        """Put the plant in the state."""
        self._plant.SetPositionsAndVelocities(self._own, self.coordinates(state))

    def get_state(self) -> State:
        """The state by Drake's own kinematics."""
        plant, own, node = self._plant, self._own, self._node
        attitude = plant.EvalBodyPoseInWorld(own, node).rotation()
        spin = plant.EvalBodySpatialVelocityInWorld(own, node).rotational()
        return State(
            attitude.ToQuaternion().wxyz(),
            attitude.matrix().T @ spin,
            plant.CalcCenterOfMassPositionInWorld(own),
            plant.CalcCenterOfMassTranslationalVelocityInWorld(own),
        )

    def forward(self, state: State) -> tuple[Array, Array]:
        """omega-dot (3,), body, and the acceleration of the centre of mass (3,), world.

        From the plant's generalised acceleration. ``d omega / dt`` is the same vector in both axes,
        as ``omega x omega`` is nothing.
        """
        self.set_state(state)
        found = self._plant.EvalBodySpatialAccelerationInWorld(self._own, self._node)
        linear = self._plant.CalcCenterOfMassTranslationalAccelerationInWorld(self._own)
        return rotate_inverse(state.orientation, found.rotational()), linear

    def inverse(self, state: State, wanted: Acceleration) -> Array:
        """The torque (3,), body axes, by `MultibodyPlant.CalcInverseDynamics` without forces.

        About the centre of mass, or about the pivot, where the torque of gravity is subtracted.
        """
        self.set_state(state)
        q, w = state.orientation, state.angular_velocity
        known = rotate(q, wanted.angular)
        if self.model.free:
            lifted = cross(wanted.angular, self._center) + cross(w, cross(w, self._center))
            known = np.concatenate((known, wanted.linear - rotate(q, lifted)))
        none = self._drake.MultibodyForces(self._plant)
        found = self._plant.CalcInverseDynamics(self._own, known, none)
        if not self.model.free:
            return rotate_inverse(q, found - self._plant.CalcGravityGeneralizedForces(self._own))
        torque, force = rotate_inverse(q, found[:3]), rotate_inverse(q, found[3:])
        return torque - cross(self._center, force)


def quaternions_of(angles: Array) -> Array:
    """Unit quaternions (n, 4) of roll, pitch and yaw (n, 3)."""
    c, s = np.cos(0.5 * angles), np.sin(0.5 * angles)
    roll, pitch, yaw = np.zeros((3, len(angles), 4))
    for axis, turn in enumerate((roll, pitch, yaw)):
        turn[:, 0], turn[:, 1 + axis] = c[:, axis], s[:, axis]
    return normalize(quaternion_product(yaw, quaternion_product(pitch, roll)))
