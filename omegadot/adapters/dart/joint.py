"""States of a DART body in named frames, its dynamics, its loads and its step.

The frame of a joint's own velocities differs between joints and versions of DART. Here they are
never read: states are set through calls that name their frames, or through the joint's Jacobian J,
for which ``V = J qdot`` and ``V' = J qddot + J' qdot`` give the body's spatial velocity and
acceleration in body axes whatever the joint keeps. Spatial vectors are (angular, linear). For the
spatial acceleration of a point, ``a_spatial = a - omega x v``, see Featherstone, Rigid Body
Dynamics Algorithms (2008), section 2.11.
"""

from __future__ import annotations

from itertools import repeat

import numpy as np

from omegadot.adapters.dart.model import DartModel
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import rotation_matrix
from omegadot.reference_impl.system import Acceleration, Array, State, System


class DartJoint:
    """The body of a `DartModel` under the loads of its system."""

    def __init__(self, model: DartModel, system: System) -> None:
        load = system.load
        self.model = model
        self._frame, self._node, self._joint = model.frame, model.node, model.joint
        self._free = load.pivot is None
        self._com = np.array(system.body.center_of_mass, float)
        self._damping = float(load.damping)
        self._torque_body = np.array(load.torque_body, float)
        self._torque_world = np.array(load.torque_world, float)
        self._in_body = bool(self._damping or self._torque_body.any())
        self._in_world = bool(self._torque_world.any())

    def set_state(self, state: State) -> None:
        """Put the joint in the state; a pivoted body takes orientation and angular velocity."""
        world_R_body = rotation_matrix(np.array(state.orientation, float))
        omega, joint = np.array(state.angular_velocity, float), self._joint
        if not self._free:
            joint.setPositions(joint.convertToPositions(self.model.turn.T @ world_R_body))
            joint.setVelocities(np.linalg.solve(joint.getRelativeJacobian()[:3], omega))
            return
        origin = state.position - world_R_body @ self._com
        joint.setTransform(self.model.transform(world_R_body, origin))
        velocity = state.linear_velocity @ world_R_body - cross(omega, self._com)
        joint.setSpatialVelocity(np.concatenate([omega, velocity]), self._frame, self._node)

    def get_state(self) -> State:
        """The body node's state in the project's frames; NaN where DART's own is not finite."""
        if not self.is_finite():
            return State(np.full(4, np.nan), *np.full((3, 3), np.nan))
        node, world = self._node, self._frame
        q = node.getTransform().quaternion()
        return State(
            np.array([q.w(), q.x(), q.y(), q.z()]),
            node.getAngularVelocity(world, node),
            node.getCOM(world),
            node.getCOMLinearVelocity(world, world),
        )

    def is_finite(self) -> bool:
        """Whether the joint's own coordinates and the squares of its velocities are finite."""
        position, velocity = self._joint.getPositions(), self._joint.getVelocities()
        # x - x is nan for nan and inf, and a product of Python floats overflows without a warning
        return all(x - x == 0 for x in position.tolist()) and all(
            v * v - v * v == 0 for v in velocity.tolist()
        )

    def forward(self) -> tuple[Array, Array]:
        """omega-dot (3,), body, and the acceleration of the centre of mass (3,), world."""
        if not self.is_finite():
            return np.full(3, np.nan), np.full(3, np.nan)
        self._push()
        self.model.skeleton.computeForwardDynamics()
        self._node.clearExternalForces()
        return (
            self._node.getAngularAcceleration(self._frame, self._node),
            self._node.getCOMLinearAcceleration(self._frame, self._frame),
        )

    def inverse(self, state: State, wanted: Acceleration) -> Array:
        """The torque (3,), body axes, about the centre of mass or about the pivot.

        The joint must be in the state.
        """
        return self.wrench(state, wanted)[:3]

    def wrench(self, state: State, wanted: Acceleration) -> Array:
        """Torque and force (6,) at a free body's centre of mass, body axes; torque (3,) if pivoted.

        The joint's forces are ``Q = J^T W`` with W = (torque, force) at the body origin.
        """
        if not self.is_finite():
            return np.full(6 if self._free else 3, np.nan)
        joint, target = self._joint, self._spatial(state, wanted)
        J = joint.getRelativeJacobian()[: len(target)]
        bias = joint.getRelativeJacobianTimeDeriv()[: len(target)] @ joint.getVelocities()
        joint.setAccelerations(np.linalg.solve(J, target - bias))
        self.model.skeleton.computeInverseDynamics()
        found: Array = np.linalg.solve(J.T, joint.getForces())
        if self._free:
            found[:3] -= cross(self._com, found[3:])
        return found

    def _spatial(self, state: State, wanted: Acceleration) -> Array:
        """The spatial acceleration (6,) of the body origin in body axes; angular alone if pivoted.

        ``a_origin - omega x v_origin = R^T a_com - omega x R^T v_com - omega_dot x c``.
        """
        angular = np.array(wanted.angular, float)
        if not self._free:
            return angular
        world_R_body = rotation_matrix(state.orientation)
        velocity, linear = state.linear_velocity @ world_R_body, wanted.linear @ world_R_body
        moved = cross(state.angular_velocity, velocity) + cross(angular, self._com)
        return np.concatenate([angular, linear - moved])

    def start(self, state: State, timestep: float) -> None:
        """A world at time zero in this state, with nothing left of earlier runs."""
        self.model.skeleton.resetGeneralizedForces()
        self.model.skeleton.resetAccelerations()
        self.model.skeleton.clearExternalForces()
        self.model.world.setTime(0.0)
        self.model.world.setTimeStep(timestep)
        self.set_state(state)

    def step(self, count: int) -> None:
        """`World.step`, count times, the loads pushed anew before each."""
        step, push = self.model.world.step, self._push
        if not (self._in_body or self._in_world):
            for _ in repeat(None, count):
                step()
            return
        for _ in repeat(None, count):
            push()
            step()

    def _push(self) -> None:
        """Damping and applied torques as external torques; a step clears them."""
        if self._in_body:
            omega = self._node.getAngularVelocity(self._frame, self._node)
            self._node.addExtTorque(self._torque_body - self._damping * omega, True)
        if self._in_world:
            self._node.addExtTorque(self._torque_world, False)
