"""One body of a biorbd model: its coordinates, and its dynamics at one state."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from omegadot.adapters.biorbd.model import SEGMENT, build_model, read_back
from omegadot.adapters.biorbd.motion import body_motion, own_coordinates
from omegadot.adapters.body_files import origin_at_pivot
from omegadot.reference_impl.coordinates import from_coordinates, to_coordinates
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.system import Acceleration, Array, Body, State, System


class BiorbdJoint:
    """A free body, or one on a quaternion at its pivot, in body axes."""

    def __init__(self, engine: Any, system: System) -> None:
        self.system = system
        self._free = system.load.pivot is None
        self._model = build_model(engine, system, damped=True)
        # InverseDynamics has damping with the sign that it has in ForwardDynamics
        self._undamped = build_model(engine, system, damped=False)
        self._lever = np.array(read_back(self._model).center_of_mass)
        self.motion = body_motion(self._model, system.load)
        self._own = own_coordinates(*self.coordinates(_at_rest()))[:2]

    def body(self) -> Body:
        """Mass, centre of mass and inertia that the model holds."""
        found = read_back(self._model)
        center = found.center_of_mass + origin_at_pivot(self.system)
        return Body(found.mass, center, found.inertia)

    def set_state(self, state: State) -> None:
        """Keep the state as biorbd's coordinates."""
        self._own = own_coordinates(*self.coordinates(state))[:2]

    def get_state(self) -> State:
        """The state by biorbd's kinematics, at the centre of mass."""
        q, v = self._own
        frame = self._model.globalJCS(q, SEGMENT).to_array()[:3, :3]
        spin = self._model.segmentAngularVelocity(q, v, SEGMENT).to_array()
        quaternion = np.roll(Rotation.from_matrix(frame).as_quat(), 1)
        return State(
            quaternion,
            rotate_inverse(quaternion, spin),
            np.array(self._model.CoM(q).to_array()),
            np.array(self._model.CoMdot(q, v).to_array()),
        )

    def forward(self, q: Array, v: Array) -> tuple[Array, Array]:
        """omega-dot (3,), body, and the acceleration of the centre of mass (3,), world.

        The second is by `CoMddot`.
        """
        found = self.motion.acceleration(q, v)
        own_q, own_v, unit = own_coordinates(q, v)
        own = np.array(found)
        if self._free:
            turned = np.cross(v[3:], v[:3]) + found[:3]
            own[:3] = rotate(np.array(unit), turned)
        linear: Array = self._model.CoMddot(own_q, own_v, own).to_array()
        return found[-3:], np.array(linear)

    def inverse(self, state: State, wanted: Acceleration) -> Array:
        """The torque (3,), body axes, by `InverseDynamics`, about the centre of mass or pivot."""
        if self._free:
            return self.wrench(state, wanted.angular, wanted.linear)[3:]
        q, v, _ = own_coordinates(*self.coordinates(state))
        torque: Array = self._undamped.InverseDynamics(q, v, np.array(wanted.angular)).to_array()
        return np.array(torque)

    def wrench(self, state: State, angular: Array, linear: Array) -> Array:
        """Force and torque (6,) on a free body by `InverseDynamics`, at its centre, body axes.

        The origin's acceleration is ``a - R (ω̇ x r + ω x (ω x r))``, r the centre from it.
        """
        q, v, unit = own_coordinates(*self.coordinates(state))
        lever, spin, attitude = self._lever, np.array(state.angular_velocity), np.array(unit)
        turning = np.cross(angular, lever) + np.cross(spin, np.cross(spin, lever))
        at_origin = np.concatenate((linear - rotate(attitude, turning), angular))
        found = self._undamped.InverseDynamics(q, v, at_origin).to_array()
        force = rotate_inverse(attitude, found[:3])
        return np.concatenate((force, found[3:] - np.cross(lever, force)))

    def coordinates(self, state: State) -> tuple[Array, Array]:
        """Q and v, (..., 7) and (..., 6) of a free body, (..., 4) and (..., 3) of a pivoted one."""
        q, v = to_coordinates(self.system, state, "body-spatial")
        return np.array(q, float), np.array(v, float)

    def states(self, q: Array, v: Array) -> State:
        """The states of coordinates: the inverse of `coordinates`."""
        return from_coordinates(self.system, q, v, "body-spatial")


def _at_rest() -> State:
    nowhere = np.zeros(3)
    return State(np.array([1.0, 0.0, 0.0, 0.0]), nowhere, nowhere, nowhere)
