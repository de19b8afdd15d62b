"""One body of an iDynTree model: its coordinates, and its dynamics at one state.

Everything but omega-dot is by `KinDynComputations` in body axes. Spatial vectors are (linear,
angular); the spatial acceleration of a point is ``a - ω x v``: Featherstone, Rigid Body Dynamics
Algorithms (2008), section 2.11.
"""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np

from omegadot.adapters.body_files import NAME, origin_at_pivot
from omegadot.adapters.idyntree.model import CENTER, read_back, with_center
from omegadot.adapters.idyntree.motion import body_motion, dynamics_of
from omegadot.adapters.protocol import Setup
from omegadot.reference_impl.coordinates import acceleration_in, from_coordinates, to_coordinates
from omegadot.reference_impl.system import Acceleration, Array, Body, State, System


class IDynTreeJoint:
    """A free body, or one on a spherical joint at its pivot, in body axes."""

    def __init__(self, engine: ModuleType, system: System, model: Any, setup: Setup) -> None:
        self.system = system
        self._idyn: Any = engine
        self._free = system.load.pivot is None
        self._model = with_center(engine, model)
        self._gravity = engine.Vector3.FromPython(np.array(system.load.gravity, float))
        self._dynamics = dynamics_of(engine, self._model)
        self._unloaded = engine.LinkWrenches(self._model)
        self._unloaded.zero()
        self.motion = body_motion(engine, self._model, system.load, setup)
        self._place(*self.coordinates(_at_rest()))

    def body(self) -> Body:
        """Mass, centre of mass and inertia that the model holds."""
        found = read_back(self._model)
        center = found.center_of_mass + origin_at_pivot(self.system)
        return Body(found.mass, center, found.inertia)

    def set_state(self, state: State) -> None:
        """Give `KinDynComputations` the state."""
        self._place(*self.coordinates(state))

    def get_state(self) -> State:
        """The state by the kinematics of `KinDynComputations`, at the centre of mass."""
        world_R_body, velocity = self._motion_of_center()
        place = self._dynamics.getWorldTransform(CENTER)  # what it gives are references into it
        return State(
            place.getRotation().asQuaternion().toNumPy(),
            velocity[3:],
            place.getPosition().toNumPy(),
            world_R_body @ velocity[:3],
        )

    def _motion_of_center(self) -> tuple[Array, Array]:
        """The body's rotation (3, 3), and the spatial velocity (6,) of its centre, body axes."""
        place = self._dynamics.getWorldTransform(CENTER)
        velocity: Array = self._dynamics.getFrameVel(CENTER).toNumPy()
        return place.getRotation().toNumPy(), velocity

    def forward(self, q: Array, v: Array) -> tuple[Array, Array]:
        """omega-dot (3,), body, and the acceleration of the centre of mass (3,), world.

        The second is that of a frame there, by `getFrameAcc`.
        """
        found = self.motion.acceleration(q, v)
        self._place(q, v)
        spatial = self._dynamics.getFrameAcc(CENTER, *self._parts(found)).toNumPy()
        world_R_body, velocity = self._motion_of_center()
        linear = world_R_body @ (spatial[:3] + np.cross(velocity[3:], velocity[:3]))
        return found[-3:], linear

    def inverse(self, state: State, wanted: Acceleration) -> Array:
        """The torque (3,), body axes, by RNEA, about the centre of mass or about the pivot."""
        if self._free:
            return self.wrench(state, wanted.angular, wanted.linear)[3:]
        required = self._required(state, wanted)
        torque: Array = required.jointTorques().toNumPy()
        return torque

    def wrench(self, state: State, angular: Array, linear: Array) -> Array:
        """Force and torque (6,) on a free body by RNEA, at its centre of mass, in body axes."""
        # its parts are references into it
        required = self._required(state, Acceleration(angular, linear))
        center = self._dynamics.getRelativeTransform(CENTER, NAME)
        found: Array = (center * required.baseWrench()).toNumPy()
        return found

    def _required(self, state: State, wanted: Acceleration) -> Any:
        self.set_state(state)
        found = self._idyn.FreeFloatingGeneralizedTorques(self._model)
        parts = self._parts(acceleration_in(self.system, state, wanted, "body-spatial"))
        self._dynamics.inverseDynamics(*parts, self._unloaded, found)
        return found

    def _parts(self, values: Array) -> tuple[Any, Any]:
        """Accelerations as those of the base and of the joint."""
        base, joint = (values, np.zeros(0)) if self._free else (np.zeros(6), np.array(values))
        return self._idyn.Vector6.FromPython(base), self._idyn.VectorDynSize.FromPython(joint)

    def _place(self, q: Array, v: Array) -> None:
        idyn, vector = self._idyn, self._idyn.VectorDynSize.FromPython
        if self._free:
            turned = idyn.Rotation.RotationFromQuaternion(idyn.Vector4.FromPython(q[3:].copy()))
            place = idyn.Transform(turned, idyn.Position.FromPython(q[:3].copy()))
            none = vector(np.zeros(0))
            parts = (place, none, idyn.Twist.FromPython(v), none)
        else:
            parts = (idyn.Transform.Identity(), vector(q), idyn.Twist.Zero(), vector(v))
        self._dynamics.setRobotState(*parts, self._gravity)

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
