"""States of an OpenSim body in the project's frames, and its dynamics.

The coordinates y of a free joint are its three angles, its place and an unused number, then omega
and the velocity of the body's origin, all in the axes of the joint's frame in the ground; those of
a ball joint are the angles, an unused number and omega.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.opensim.charts import Chart
from omegadot.adapters.opensim.model import OpenSimModel, array, attitude, vec3
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.kinematics import at_point, place_on_pivot
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.system import Acceleration, Array, Body, State, System


def coordinates(system: System, chart: Chart, state: State) -> Array:
    """The coordinates y of a state: (13,) of a free body, (7,) of a pivoted one."""
    q = np.array(state.orientation, float)
    spin = chart.in_frame(rotate(q, state.angular_velocity))
    if system.load.pivot is not None:
        return np.concatenate((chart.angles_of(q), [0.0], spin))
    origin = at_point(state, -system.body.center_of_mass)
    at, moving = chart.in_frame(origin.position), chart.in_frame(origin.linear_velocity)
    return np.concatenate((chart.angles_of(q), at, [0.0], spin, moving))


def states(system: System, chart: Chart, rows: Array) -> State:
    """The states of such coordinates (n, 13) or (n, 7)."""
    q = chart.quaternions_of(rows[:, :3])
    if system.load.pivot is not None:
        spin, nowhere = rotate_inverse(q, chart.in_world(rows[:, 4:])), np.zeros((len(rows), 3))
        return place_on_pivot(system, State(q, spin, nowhere, nowhere))
    at, spin, moving = (chart.in_world(rows[:, first : first + 3]) for first in (3, 7, 10))
    state = State(q, rotate_inverse(q, spin), at, moving)
    return at_point(state, system.body.center_of_mass)


class OpenSimJoint:
    """The body, in the chart that is apt for a state.

    models, undriven: a model by chart, the second ones without damping and torques.
    """

    def __init__(
        self, opensim: Any, models: dict[Chart, OpenSimModel], undriven: dict[Chart, OpenSimModel]
    ) -> None:
        self._opensim, self.models = opensim, models
        self._undriven = {
            chart: (model, opensim.InverseDynamicsSolver(model.model))
            for chart, model in undriven.items()
        }
        self._now = next(iter(models.values()))
        self.system = self._now.system
        self._center = vec3(opensim, self.system.body.center_of_mass)

    def body(self) -> Body:
        """Mass, centre of mass and inertia, read back."""
        return self._now.body()

    def chart_for(self, state: State) -> Chart:
        """The chart whose singularity is far from this attitude, where there are two."""
        apt = (c for c in self.models if c.is_apt(*c.angles_of(state.orientation)[:2]))
        return next(apt, next(iter(self.models)))

    def set_state(self, state: State) -> None:
        """Put the joint in the state."""
        self._now = self.models[self.chart_for(state)]
        self._now.put(coordinates(self.system, self._now.chart, state))

    def get_state(self) -> State:
        """The state by OpenSim's own kinematics of the body."""
        own, node, at = self._now.state, self._now.node, self._center
        self._now.model.realizeVelocity(own)
        q = attitude(node, own)
        return State(
            q,
            rotate_inverse(q, array(node.getAngularVelocityInGround(own))),
            array(node.findStationLocationInGround(own, at)),
            array(node.findStationVelocityInGround(own, at)),
        )

    def forward(self, state: State) -> tuple[Array, Array]:
        """omega-dot (3,), body, and the acceleration of the centre of mass (3,), world.

        ``d omega / dt`` is the same vector in both axes, as ``omega x omega`` is nothing.
        """
        self.set_state(state)
        own, node = self._now.state, self._now.node
        self._now.model.realizeAcceleration(own)
        angular = array(node.getAngularAccelerationInGround(own))
        linear = array(node.findStationAccelerationInGround(own, self._center))
        return rotate_inverse(state.orientation, angular), linear

    def inverse(self, state: State, wanted: Acceleration) -> Array:
        """The torque (3,), body axes, by `InverseDynamicsSolver`, gravity being the only force.

        About the centre of mass, or about the pivot, where the torque of gravity is subtracted.
        """
        model, solver = self._undriven[self.chart_for(state)]
        system, chart, q = self.system, model.chart, state.orientation
        known = chart.in_frame(rotate(q, wanted.angular))
        center, w = system.body.center_of_mass, state.angular_velocity
        if model.free:
            lifted = cross(wanted.angular, center) + cross(w, cross(w, center))
            moving = chart.in_frame(wanted.linear - rotate(q, lifted))
            known = np.concatenate((known, moving))
        own = model.put(coordinates(system, chart, state))
        found = array(solver.solve(own, self._opensim.Vector.createFromMat(known)))
        torque = rotate_inverse(q, chart.in_world(found[:3]))
        if not model.free:
            return torque
        return torque - cross(center, rotate_inverse(q, chart.in_world(found[3:])))
