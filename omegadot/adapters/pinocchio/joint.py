"""One body on a joint of Pinocchio's: its model, its coordinates, and one call of ABA or RNEA.

Every conversion between frames at a state goes through Pinocchio's own kinematics where it has
one. Spatial vectors are (linear, angular). See Featherstone, Rigid Body Dynamics Algorithms
(2008), section 2.11, for the spatial acceleration of a point: ``a_spatial = a - omega x v``.
"""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np

from omegadot.reference_impl.system import Array, Body, State, System


class PinocchioJoint:
    """A free-flyer joint at the body origin, or a spherical joint at the pivot.

    Joint axes are the body's, so omega and omega-dot are the joint's own angular parts.
    """

    def __init__(self, engine: ModuleType, system: System) -> None:
        body, load = system.body, system.load
        self.system = system
        self._pin: Any = engine
        self._free = load.pivot is None
        self._origin = np.zeros(3) if load.pivot is None else np.array(load.pivot, float)
        self._model = self._pin.Model()
        kind = self._pin.JointModelFreeFlyer if self._free else self._pin.JointModelSpherical
        self._id = self._model.addJoint(0, kind(), self._pin.SE3.Identity(), "body")
        lever = np.array(body.center_of_mass, float) - self._origin
        inertia = np.array(body.inertia, float)
        self._model.inertias[self._id] = self._pin.Inertia(float(body.mass), lever, inertia)
        self._model.gravity.linear = np.array(load.gravity, float)
        self._data = self._model.createData()
        self._joint_M_com = self._pin.SE3(np.eye(3), lever)
        self._damping = float(load.damping)
        self._torque_body = np.array(load.torque_body, float)
        self._torque_world = np.array(load.torque_world, float)
        self._loaded = bool(self._damping or self._torque_body.any() or self._torque_world.any())
        self._no_torque = np.zeros(self._model.nv)
        self._q, self._v = self._pin.neutral(self._model), np.zeros(self._model.nv)

    def body(self) -> Body:
        """Mass, centre of mass and inertia that ABA and RNEA work with."""
        inertia = self._model.inertias[self._id]
        return Body(np.array(inertia.mass), inertia.lever + self._origin, inertia.inertia.copy())

    def set_state(self, state: State) -> None:
        """Keep the state as joint coordinates."""
        self._q, self._v, _ = self._coordinates(state)

    def get_state(self) -> State:
        """The state by `pinocchio.centerOfMass`, which runs the forward kinematics as well."""
        self._pin.centerOfMass(self._model, self._data, self._q, self._v, False)
        x, y, z, w = self._pin.Quaternion(self._data.oMi[self._id].rotation).coeffs()
        return State(
            np.array([w, x, y, z]),
            self._data.v[self._id].angular.copy(),
            self._data.com[0].copy(),
            self._data.vcom[0].copy(),
        )

    def forward(self, state: State) -> tuple[Array, Array]:
        """omega-dot (3,), body, and the acceleration of the centre of mass (3,), world.

        The first is ABA's; the second is ABA's joint acceleration taken to the centre of mass by
        `pinocchio.centerOfMass`.
        """
        q, v, world_R_body = self._coordinates(state)
        torque = self._torque(state, world_R_body) if self._loaded else self._no_torque
        a = self._pin.aba(self._model, self._data, q, v, torque)
        self._pin.centerOfMass(self._model, self._data, q, v, a, False)
        # both are Pinocchio's own memory, which its next call writes over
        return a[-3:].copy(), self._data.acom[0].copy()

    def inverse(self, state: State, angular: Array, linear: Array) -> Array:
        """The torque (3,), body axes, by RNEA, about the centre of mass or about the pivot."""
        if self._free:
            return self.wrench(state, angular, linear)[3:]
        q, v, _ = self._coordinates(state)
        torque: Array = self._pin.rnea(self._model, self._data, q, v, np.array(angular))
        return torque.copy()

    def wrench(self, state: State, angular: Array, linear: Array) -> Array:
        """Force and torque (6,) on a free body by RNEA, at its centre of mass, in body axes.

        ``a_spatial`` of the centre of mass is ``R^T a - omega x R^T v``.
        """
        q, v, world_R_body = self._coordinates(state)
        turning = self._pin.skew(state.angular_velocity) @ (state.linear_velocity @ world_R_body)
        at_com = self._pin.Motion(linear @ world_R_body - turning, np.array(angular))
        a = self._joint_M_com.act(at_com).vector
        at_joint = self._pin.Force(self._pin.rnea(self._model, self._data, q, v, a))
        found: Array = self._joint_M_com.actInv(at_joint).vector
        return found.copy()

    def _coordinates(self, state: State) -> tuple[Array, Array, Array]:
        """q, v of the joint, and world_R_body."""
        w, x, y, z = state.orientation.tolist()
        world_R_body = self._pin.Quaternion(w, x, y, z).toRotationMatrix()
        omega = np.array(state.angular_velocity, float)
        if not self._free:
            return np.array([x, y, z, w]), omega, world_R_body
        position = state.position - world_R_body @ self._joint_M_com.translation
        com_velocity = self._pin.Motion(state.linear_velocity @ world_R_body, omega)
        v = self._joint_M_com.act(com_velocity).vector
        return np.array([*position.tolist(), x, y, z, w]), v, world_R_body

    def _torque(self, state: State, world_R_body: Array) -> Array:
        """The applied torques and the damping as a joint torque; a couple has no linear part."""
        couple = self._torque_body + self._torque_world @ world_R_body
        couple = couple - self._damping * state.angular_velocity
        return np.concatenate([self._no_torque[3:], couple])
