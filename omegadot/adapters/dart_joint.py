"""One body on a joint of DART's: its world, its states in named frames, its loads and its step.

The frame of a joint's own velocities differs between joints and versions of DART. Here they are
never read: states are set through calls that name their frames, or through the joint's Jacobian J,
for which ``V = J qdot`` and ``V' = J qddot + J' qdot`` give the body's spatial velocity and
acceleration in body axes whatever the joint keeps. Spatial vectors are (angular, linear).
"""

from __future__ import annotations

from itertools import repeat
from types import ModuleType
from typing import Any

import numpy as np

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import rotation_matrix
from omegadot.reference_impl.system import Array, Body, State, System

SWITCHED_OFF = (
    "deactivation of slow bodies (World.setDeactivationOptions, where the version has it)",
    "enforcement of joint limits (Joint.setLimitEnforcement)",
    "collision: bodies have no shapes",
    "joint frames in line with the world: they are turned by 120 degrees about (1, 1, 1), so that "
    "attitudes near the identity are not rotation vectors below 1e-3 rad, which DART expands to "
    "second order",
)
# math::expMapRot takes 1 + [r] + [r]^2/2 for |r| < 1e-3, off by |r|^3/6. A permutation of the axes
# turns without rounding.
TURN = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
Reading = tuple[Array, Array, Array, Array]
_NAN: Reading = (np.full(4, np.nan), *(np.full(3, np.nan) for _ in range(3)))  # type: ignore[assignment]


class DartJoint:
    """A FreeJoint at the body origin, or a BallJoint at the pivot, in a world of its own."""

    def __init__(self, engine: ModuleType, system: System, *, physics: bool) -> None:
        body, load = system.body, system.load
        dynamics, self._isometry = engine.dynamics, engine.math.Isometry3
        self._free = load.pivot is None
        self._com = np.array(body.center_of_mass, float)
        self._world: Any = engine.simulation.World()
        self._world.setGravity(np.array(load.gravity, float))
        self._skeleton: Any = dynamics.Skeleton()
        self._frame: Any = dynamics.Frame.World()
        if load.pivot is None:
            self._joint, self._node = self._skeleton.createFreeJointAndBodyNodePair()
        else:
            self._joint, self._node = self._skeleton.createBallJointAndBodyNodePair()
            pivot = self._isometry(np.eye(3), np.array(load.pivot, float))
            self._joint.setTransformFromChildBodyNode(pivot)
        inertia = np.array(body.inertia, float)
        self._node.setInertia(dynamics.Inertia(float(body.mass), self._com, inertia))
        self._world.addSkeleton(self._skeleton)
        self._damping = float(load.damping)
        self._torque_body = np.array(load.torque_body, float)
        self._torque_world = np.array(load.torque_world, float)
        self._turn = TURN if physics else np.eye(3)
        if physics:
            self._switch_off()

    def _switch_off(self) -> None:
        """What ``SWITCHED_OFF`` lists; old versions lack some of it."""
        if hasattr(self._world, "setDeactivationOptions"):
            options = self._world.getDeactivationOptions()
            options.mEnabled = False
            self._world.setDeactivationOptions(options)
        self._joint.setLimitEnforcement(False)
        self._joint.setTransformFromParentBodyNode(self._isometry(self._turn, np.zeros(3)))

    def body(self) -> Body:
        """Mass, centre of mass and inertia about it, as the body node holds them."""
        inertia = self._node.getInertia()
        return Body(np.array(inertia.getMass()), inertia.getLocalCOM(), inertia.getMoment())

    def set_state(self, state: State) -> None:
        """Put the joint in the state; a pivoted body takes orientation and angular velocity."""
        world_R_body = rotation_matrix(np.array(state.orientation, float))
        omega = np.array(state.angular_velocity, float)
        if not self._free:
            vector = self._joint.convertToPositions(self._turn.T @ world_R_body)
            self._joint.setPositions(vector)
            self._joint.setVelocities(np.linalg.solve(self._joint.getRelativeJacobian()[:3], omega))
            return
        origin = state.position - world_R_body @ self._com
        self._joint.setTransform(self._isometry(world_R_body, origin))
        velocity = state.linear_velocity @ world_R_body - cross(omega, self._com)
        twist = np.concatenate([omega, velocity])
        self._joint.setSpatialVelocity(twist, self._frame, self._node)

    def get_state(self) -> Reading:
        """Orientation, angular velocity, position, linear velocity in the project's frames."""
        if not self.is_finite():
            return _NAN
        q, node = self._node.getTransform().quaternion(), self._node
        return (
            np.array([q.w(), q.x(), q.y(), q.z()]),
            node.getAngularVelocity(self._frame, node),
            node.getCOM(self._frame),
            node.getCOMLinearVelocity(self._frame, self._frame),
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
            return _NAN[1], _NAN[1]
        self._push()
        self._skeleton.computeForwardDynamics()
        self._node.clearExternalForces()
        return (
            self._node.getAngularAcceleration(self._frame, self._node),
            self._node.getCOMLinearAcceleration(self._frame, self._frame),
        )

    def inverse(self, state: State, angular: Array, linear: Array) -> Array:
        """The torque (3,), body axes, about the centre of mass or about the pivot.

        The joint's forces are ``Q = J^T W`` with W = (torque, force) at the body origin.
        """
        if not self.is_finite():
            return _NAN[1]
        J, J_dot = self._joint.getRelativeJacobian(), self._joint.getRelativeJacobianTimeDeriv()
        wanted = np.array(angular, float)
        if self._free:
            world_R_body = rotation_matrix(state.orientation)
            omega = state.angular_velocity
            spatial = linear @ world_R_body - cross(omega, state.linear_velocity @ world_R_body)
            wanted = np.concatenate([wanted, spatial - cross(wanted, self._com)])
        rows = len(wanted)
        bias = J_dot[:rows] @ self._joint.getVelocities()
        self._joint.setAccelerations(np.linalg.solve(J[:rows], wanted - bias))
        self._skeleton.computeInverseDynamics()
        wrench: Array = np.linalg.solve(J[:rows].T, self._joint.getForces())
        self._joint.resetForces()  # else they would push the body in the next step
        return wrench[:3] - cross(self._com, wrench[3:]) if self._free else wrench

    def start(self, state: State, timestep: float) -> None:
        """A world at time zero in this state, with nothing left of earlier runs."""
        self._skeleton.resetGeneralizedForces()
        self._skeleton.resetAccelerations()
        self._skeleton.clearExternalForces()
        self._world.setTime(0.0)
        self._world.setTimeStep(timestep)
        self.set_state(state)

    def step(self, count: int) -> None:
        """`World.step`, count times, the loads pushed anew before each."""
        step, push = self._world.step, self._push
        if not (self._damping or self._torque_body.any() or self._torque_world.any()):
            for _ in repeat(None, count):
                step()
            return
        for _ in repeat(None, count):
            push()
            step()

    def _push(self) -> None:
        """Damping and applied torques as external torques; a step clears them."""
        node = self._node
        if self._damping or self._torque_body.any():
            omega = node.getAngularVelocity(self._frame, node)
            node.addExtTorque(self._torque_body - self._damping * omega, True)
        if self._torque_world.any():
            node.addExtTorque(self._torque_world, False)
