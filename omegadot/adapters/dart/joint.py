"""States of a DART body in named frames, and its dynamics.

The frame of a joint's own velocities differs between joints and versions of DART. Here they are
never read: states are set through calls that name their frames, or through the joint's Jacobian J,
for which ``V = J qdot`` and ``V' = J qddot + J' qdot`` give the body's spatial velocity and
acceleration in body axes whatever the joint keeps. Spatial vectors are (angular, linear). For the
spatial acceleration of a point, ``a_spatial = a - omega x v``, see Featherstone, Rigid Body
Dynamics Algorithms (2008), section 2.11.
"""

from __future__ import annotations

import numpy as np

from omegadot.adapters.dart.model import DartModel
from omegadot.adapters.dart.stepping import DartStepper, are_finite
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import rotation_matrix
from omegadot.reference_impl.system import Acceleration, Array, Body, State, System


class DartJoint:
    """The body of a `DartModel` under the loads of its system."""

    def __init__(self, model: DartModel, system: System) -> None:
        self.model, self.stepper = model, DartStepper(model, system.load)
        self._frame, self._node, self._joint = model.frame, model.node, model.joint
        self._free = system.load.pivot is None
        self._com = np.array(system.body.center_of_mass, float)

    def body(self) -> Body:
        """Mass, centre of mass and inertia about it, as the body node holds them."""
        inertia = self._node.getInertia()
        return Body(np.array(inertia.getMass()), inertia.getLocalCOM(), inertia.getMoment())

    def set_state(self, state: State) -> None:
        """Put the joint in the state; a pivoted body takes orientation and angular velocity."""
        world_R_body = rotation_matrix(np.array(state.orientation, float))
        omega, joint = np.array(state.angular_velocity, float), self._joint
        if not self._free:
            joint.setPositions(joint.convertToPositions(self.model.turn.T @ world_R_body))
            joint.setVelocities(np.linalg.solve(joint.getRelativeJacobian()[:3], omega))
            return
        origin = state.position - world_R_body @ self._com
        joint.setTransform(self.model.isometry(world_R_body, origin))
        velocity = state.linear_velocity @ world_R_body - cross(omega, self._com)
        joint.setSpatialVelocity(np.concatenate([omega, velocity]), self._frame, self._node)

    def get_state(self) -> State:
        """The body node's state in the project's frames; NaN where DART's own is not finite."""
        return self.states([self._joint.getPositions(), self._joint.getVelocities()], 1)[0]

    def states(self, logged: list[Array], count: int) -> State:
        """The states, `count` of them, at joint positions and velocities logged in turns.

        By DART's own kinematics. They are NaN from the first coordinates on that are missing or
        not finite; the joint is left in the last that are.
        """
        joint, node, world = self._joint, self._node, self._frame
        finite = are_finite(np.array(logged[::2]), np.array(logged[1::2]))
        rows = []
        for n in range(np.count_nonzero(np.logical_and.accumulate(finite))):
            joint.setPositions(logged[2 * n])
            joint.setVelocities(logged[2 * n + 1])
            attitude, twist = node.getTransform().quaternion(), node.getCOMSpatialVelocity()
            velocity = node.getCOMLinearVelocity(world, world)
            rows.append((attitude.wxyz(), twist, node.getCOM(world), velocity))
        found = np.full((count, 16), np.nan)
        if rows:
            found[: len(rows)] = np.hstack([np.array(column) for column in zip(*rows, strict=True)])
        return State(found[:, :4], found[:, 4:7], found[:, 10:13], found[:, 13:])

    def is_finite(self) -> bool:
        """Whether the joint's own coordinates are finite, and the squares of its velocities."""
        return bool(are_finite(self._joint.getPositions(), self._joint.getVelocities()))

    def forward(self, state: State) -> tuple[Array, Array]:
        """omega-dot (3,), body, and the acceleration of the centre of mass (3,), world.

        By `Skeleton.computeForwardDynamics`.
        """
        self.set_state(state)
        if not self.is_finite():
            return np.full(3, np.nan), np.full(3, np.nan)
        self.stepper.push()
        self.model.skeleton.computeForwardDynamics()
        self._node.clearExternalForces()
        return (
            self._node.getAngularAcceleration(self._frame, self._node),
            self._node.getCOMLinearAcceleration(self._frame, self._frame),
        )

    def inverse(self, state: State, wanted: Acceleration) -> Array:
        """The torque (3,), body axes, by `Skeleton.computeInverseDynamics`.

        About the centre of mass, or about the pivot.
        """
        self.set_state(state)
        return self.wrench(state, wanted)[:3]

    def wrench(self, state: State, wanted: Acceleration) -> Array:
        """Torque and force (6,) at a free body's centre of mass, body axes; torque (3,) if pivoted.

        The joint must be in the state. Its forces are ``Q = J^T W`` with W = (torque, force) at the
        body origin.
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
