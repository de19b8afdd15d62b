"""The OpenSim model of one body: its joint and its loads.

A free body is on a `FreeJoint` at its origin, a pivoted one on a `BallJoint` at the pivot. Both
keep three angles, and omega in the axes of the joint's frame in the ground.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.opensim.charts import Chart
from omegadot.reference_impl.system import Array, Body, System

AXES = 3  # of a joint's coordinates the first ones turn


class OpenSimModel:
    """model, node (the body) and state are OpenSim's objects.

    driven: whether damping and torques act.
    """

    def __init__(self, opensim: Any, system: System, chart: Chart, driven: bool = True) -> None:
        self._opensim, self.system, self.chart = opensim, system, chart
        self.free = system.load.pivot is None
        self.model: Any = opensim.Model()
        self.model.setGravity(vec3(opensim, system.load.gravity))
        self.node: Any = self._body()
        self._joint: Any = self._held()
        if driven:
            self._drive()
        self.state: Any = self.model.initSystem()

    def _body(self) -> Any:
        opensim, body = self._opensim, self.system.body
        inertia = np.array(body.inertia, float)
        moments, products = np.diagonal(inertia), inertia[[0, 0, 1], [1, 2, 2]]
        about_center = opensim.Inertia(*map(float, (*moments, *products)))
        center = vec3(opensim, body.center_of_mass)
        made = opensim.Body("body", float(body.mass), center, about_center)
        self.model.addBody(made)
        return made

    def _held(self) -> Any:
        opensim, none = self._opensim, self._opensim.Vec3(0.0)
        kind = opensim.FreeJoint if self.free else opensim.BallJoint
        at = none if self.free else vec3(opensim, self.system.load.pivot)
        turned = opensim.Vec3(*self.chart.frame_angles)
        ground = self.model.getGround()
        joint = kind("joint", ground, none, turned, self.node, at, none)
        self.model.addJoint(joint)
        return joint

    def _drive(self) -> None:
        """Damping goes with a joint's speeds, which are omega; its angles' rates are not."""
        opensim, load = self._opensim, self.system.load
        for n in range(AXES if load.damping else 0):
            coordinate = self._joint.get_coordinates(n).getName()
            brake = opensim.SpringGeneralizedForce(coordinate)
            brake.setName(f"damping_{n}")
            brake.setStiffness(0.0)
            brake.setRestLength(0.0)
            brake.setViscosity(float(load.damping))
            self.model.addForce(brake)
        torques = (("body", load.torque_body), ("world", load.torque_world))
        for frame, torque in torques:
            if np.any(torque):
                acting = opensim.PrescribedForce(f"torque_{frame}", self.node)
                acting.set_forceIsGlobal(frame == "world")
                for each in torque:  # cloned: setTorqueFunctions leaves its own to Python to free
                    acting.updTorqueFunctions().cloneAndAppend(opensim.Constant(float(each)))
                self.model.addForce(acting)

    def put(self, y: Array, time: float = 0.0) -> Any:
        """The model's state, with these coordinates."""
        self.state.setTime(time)
        self.state.setY(self._opensim.Vector.createFromMat(y))
        return self.state

    def body(self) -> Body:
        """Mass, centre of mass and inertia about it, as Simbody's body has them.

        Of the system, with the body's axes along the ground's.
        """
        upright = np.zeros(self.state.getNY())
        upright[:AXES] = self.chart.angles_of(np.array([1.0, 0.0, 0.0, 0.0]))
        state, matter = self._opensim.State(self.state), self.model.getMatterSubsystem()
        state.setY(self._opensim.Vector.createFromMat(upright))
        self.model.realizePosition(state)
        held = matter.calcSystemCentralInertiaInGround(state)
        products, moments = array(held.getProducts()), array(held.getMoments())
        xy, xz, yz = products
        inertia = np.array([[0.0, xy, xz], [xy, 0.0, yz], [xz, yz, 0.0]]) + np.diag(moments)
        origin = array(self.node.getPositionInGround(state))
        center = array(matter.calcSystemMassCenterLocationInGround(state)) - origin
        return Body(np.array(matter.calcSystemMass(state)), center, inertia)


def vec3(opensim: Any, vector: Array | None) -> Any:
    """OpenSim's vector of three numbers."""
    return opensim.Vec3(*map(float, np.array(vector)))


def array(vector: Any) -> Array:
    """An array of OpenSim's vector."""
    found: Array = np.array(vector.to_numpy(), float)
    return found


def attitude(node: Any, state: Any) -> Array:
    """The quaternion (4,) world-from-body of a body, by Simbody."""
    pose = node.getTransformInGround(state)  # held on to: its rotation is a reference into it
    turned = pose.R().convertRotationToQuaternion()
    return np.array([turned.get(n) for n in range(4)])
