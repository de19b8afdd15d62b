"""States of a PyBullet body in the project's frames, and its inverse dynamics.

A row of a free body is its place, its quaternion, its velocity and omega, all of the frame of its
inertia and in world axes. One of a pivoted body is the joint's quaternion and omega in principal
axes. With P the principal axes in body axes, the base's attitude is R P and the joint's P^T R P.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.protocol import UnsupportedError
from omegadot.adapters.pybullet.model import PyBulletModel, ordered
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.rotations import (
    conjugate,
    normalize,
    quaternion_product,
    rotate,
    rotate_inverse,
)
from omegadot.reference_impl.system import Acceleration, Array, Body, State

NO_ACCELERATION = (0.0, 0.0, 0.0)


class PyBulletJoint:
    """The body of a model, put in states and read."""

    def __init__(self, engine: Any, model: PyBulletModel) -> None:
        self._engine, self.model = engine, model
        self._body, self._client = model.body, model.client

    def body(self) -> Body:
        """Mass, centre of mass and inertia, read back."""
        return self.model.read_back()

    def set_state(self, state: State) -> None:
        """Put the body in the state."""
        engine, frame = self._engine, self.model.frame
        q = np.array(state.orientation, float)
        own = quaternion_product(q, frame)
        spin = np.array(state.angular_velocity, float)
        if self.model.free:
            place, velocity = (
                np.array(v, float).tolist() for v in (state.position, state.linear_velocity)
            )
            engine.resetBasePositionAndOrientation(self._body, place, ordered(own), self._client)
            turning = rotate(q, spin).tolist()
            engine.resetBaseVelocity(self._body, velocity, turning, self._client)
            return
        joint = ordered(quaternion_product(conjugate(frame), own))
        turning = rotate_inverse(frame, spin).tolist()
        engine.resetJointStateMultiDof(self._body, 0, joint, turning, self._client)

    def row(self) -> tuple[float, ...]:
        """The numbers of the present state, as PyBullet has them."""
        engine, body, client = self._engine, self._body, self._client
        if self.model.free:
            place, q = engine.getBasePositionAndOrientation(body, client)
            velocity, spin = engine.getBaseVelocity(body, client)
            return (*place, *q, *velocity, *spin)
        q, spin, _, _ = engine.getJointStateMultiDof(body, 0, client)
        return (*q, *spin)

    def get_state(self) -> State:
        """The present state."""
        return self.states(np.array(self.row())[None])[0]

    def states(self, rows: Array) -> State:
        """The states of rows (n, 13) of a free body, or (n, 7) of a pivoted one."""
        frame = self.model.frame
        at = 3 if self.model.free else 0
        own = normalize(rows[:, [at + 3, at, at + 1, at + 2]])
        q = quaternion_product(own, conjugate(frame))
        if self.model.free:
            return State(q, rotate_inverse(q, rows[:, 10:]), rows[:, :3], rows[:, 7:10])
        q, spin = quaternion_product(frame, q), rotate(frame, rows[:, 4:])
        return place_on_pivot(self.model.system, State(q, spin, *np.zeros((2, len(rows), 3))))

    def inverse(self, state: State, wanted: Acceleration) -> Array:
        """The torque (3,) of `calculateInverseDynamics`, which takes velocities in own axes.

        It is about the centre of mass, so that neither gravity nor the acceleration of the centre
        of mass are part of it.  Raises UnsupportedError for a pivoted body.
        """
        if not self.model.free:
            raise UnsupportedError(
                "PyBullet's calculateInverseDynamics has three numbers for the four of a spherical "
                "joint: it has no inverse dynamics of a pivoted body"
            )
        frame = self.model.frame
        own = ordered(quaternion_product(np.array(state.orientation, float), frame))
        moving = rotate_inverse(state.orientation, state.linear_velocity)
        spin, velocity, angular = (
            rotate_inverse(frame, np.array(v, float)).tolist()
            for v in (state.angular_velocity, moving, wanted.angular)
        )
        place = np.array(state.position, float).tolist()
        found = self._engine.calculateInverseDynamics(
            self._body,
            [*place, *own],
            [*spin, *velocity],  # in this order, though the answer is (force, torque)
            [*angular, *NO_ACCELERATION],
            physicsClientId=self._client,
        )
        return rotate(frame, np.array(found[3:]))
