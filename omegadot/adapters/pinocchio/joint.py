"""One body on a joint of Pinocchio's: its model, its coordinates, and one call of ABA or RNEA.

Spatial vectors are (linear, angular). See Featherstone, Rigid Body Dynamics Algorithms (2008),
section 2.11, for the spatial acceleration of a point: ``a_spatial = a - omega x v``.
"""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np

from omegadot.adapters.body_files import origin_at_pivot
from omegadot.adapters.joint_torque import joint_torque
from omegadot.adapters.pinocchio.model import JOINT
from omegadot.adapters.pinocchio.motion import joint_motion
from omegadot.reference_impl.coordinates import from_coordinates, to_coordinates
from omegadot.reference_impl.system import Acceleration, Array, Body, State, System


class PinocchioJoint:
    """A free-flyer joint at the body origin, or a spherical joint at the pivot.

    Joint axes are the body's, so omega and omega-dot are the joint's own angular parts.
    """

    def __init__(self, engine: ModuleType, system: System, model: Any) -> None:
        load = system.load
        self.system = system
        self._pin: Any = engine
        self._free = load.pivot is None
        self._origin = origin_at_pivot(system)
        self._model, self._id = model, JOINT
        lever = np.array(system.body.center_of_mass, float) - self._origin
        self._model.gravity.linear = np.array(load.gravity, float)
        self._data = self._model.createData()
        self._joint_M_com = self._pin.SE3(np.eye(3), lever)
        self._torque = joint_torque(load, self._model.nv, scalar_last=True)
        self.motion = joint_motion(engine, self._model, load)
        self._q, self._v = self._pin.neutral(self._model), np.zeros(self._model.nv)

    def body(self) -> Body:
        """Mass, centre of mass and inertia that ABA and RNEA work with."""
        inertia = self._model.inertias[self._id]
        return Body(np.array(inertia.mass), inertia.lever + self._origin, inertia.inertia.copy())

    def set_state(self, state: State) -> None:
        """Keep the state as joint coordinates."""
        self._q, self._v = self.coordinates(state)

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

    def forward(self, q: Array, v: Array) -> tuple[Array, Array]:
        """omega-dot (3,), body, and the acceleration of the centre of mass (3,), world.

        The first is ABA's; the second is ABA's joint acceleration taken to the centre of mass by
        `pinocchio.centerOfMass`.
        """
        torque = self._torque(q, v) if callable(self._torque) else self._torque
        a = self._pin.aba(self._model, self._data, q, v, torque)
        self._pin.centerOfMass(self._model, self._data, q, v, a, False)
        # both are Pinocchio's own memory, which its next call writes over
        return a[-3:].copy(), self._data.acom[0].copy()

    def inverse(self, state: State, wanted: Acceleration) -> Array:
        """The torque (3,), body axes, by RNEA, about the centre of mass or about the pivot."""
        if self._free:
            return self.wrench(state, wanted.angular, wanted.linear)[3:]
        q, v = self.coordinates(state)
        torque: Array = self._pin.rnea(self._model, self._data, q, v, np.array(wanted.angular))
        return torque.copy()

    def wrench(self, state: State, angular: Array, linear: Array) -> Array:
        """Force and torque (6,) on a free body by RNEA, at its centre of mass, in body axes.

        ``a_spatial`` of the centre of mass is ``R^T a - omega x R^T v``.
        """
        q, v = self.coordinates(state)
        world_R_body = self._pin.Quaternion(q[-4:]).toRotationMatrix()
        turning = self._pin.skew(state.angular_velocity) @ (state.linear_velocity @ world_R_body)
        at_com = self._pin.Motion(linear @ world_R_body - turning, np.array(angular))
        a = self._joint_M_com.act(at_com).vector
        at_joint = self._pin.Force(self._pin.rnea(self._model, self._data, q, v, a))
        found: Array = self._joint_M_com.actInv(at_joint).vector
        return found.copy()

    def coordinates(self, state: State) -> tuple[Array, Array]:
        """Q and v of the joint, (..., 7) and (..., 6) of a free flyer, (..., 4) and (..., 3)."""
        q, v = to_coordinates(self.system, state, "body-spatial")
        scalar_last = (q[..., :-4], q[..., -3:], q[..., -4:-3])
        return np.concatenate(scalar_last, axis=-1, dtype=float), np.array(v, float)

    def states(self, q: Array, v: Array) -> State:
        """The states of joint coordinates: the inverse of `coordinates`."""
        scalar_first = np.concatenate((q[..., :-4], q[..., -1:], q[..., -4:-1]), axis=-1)
        return from_coordinates(self.system, scalar_first, v, "body-spatial")
