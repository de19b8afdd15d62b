"""States of an Exudyn body in the project's frames, and its dynamics."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from omegadot.adapters.exudyn.model import ExudynModel
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.kinematics import at_point, place_on_pivot
from omegadot.reference_impl.rotations import normalize, rotate, rotate_inverse
from omegadot.reference_impl.system import Acceleration, Array, Body, State


def coordinates(model: ExudynModel, state: State) -> tuple[Array, Array]:
    """The node's coordinates and their rates, (6,) each, or (7,) of Euler parameters."""
    attitude, turning = model.node_kind.given(
        model.axes.of_node(normalize(np.array(state.orientation, float))),
        model.axes.in_node(np.array(state.angular_velocity, float)),
    )
    at: Array = np.zeros(3)
    moving: Array = np.zeros(3)
    if model.system.load.pivot is None:
        node = at_point(state, -model.center)
        at, moving = node.position, node.linear_velocity
    return np.concatenate((at, attitude)), np.concatenate((moving, turning))


def states(model: ExudynModel, rows: Array) -> State:
    """The states of coordinates with their rates, (n, 12) or (n, 14)."""
    places, rates = np.split(rows, 2, axis=-1)
    q, w = model.node_kind.read(places[:, 3:], rates[:, 3:])
    q, w = model.axes.of_body(q), model.axes.in_body(w)
    found = State(q, w, places[:, :3], rates[:, :3])
    if model.system.load.pivot is not None:
        return place_on_pivot(model.system, found)
    return at_point(found, model.center)


class ExudynJoint:
    """The body of a model with a node of the rotation vector: no equation but the motion's.

    A node of Euler parameters has their length as a constraint, and with it accelerations from
    difference quotients; one of Rxyz has a singularity.
    """

    def __init__(self, exudyn: Any, model: ExudynModel, undriven: ExudynModel) -> None:
        self._exudyn, self.model, self._undriven = exudyn, model, undriven
        self._kinds, self._now = model.kinds, exudyn.ConfigurationType.Current
        self._settings = exudyn.SimulationSettings()
        self._settings.solution.file.write = False
        self._settings.solution.sensors.active = False
        # Dense solvers lose two digits of a small body's omega-dot on a pivot: they begin with the
        # forces, m |c| in the columns of omega-dot, which are larger there than its own equations.
        self._settings.linearSolver.solverType = exudyn.LinearSolverType.EigenSparse

    def body(self) -> Body:
        """Mass, centre of mass and inertia, read back."""
        return self.model.read_back()

    def set_state(self, state: State) -> None:
        """Put the node in the state."""
        place(self._exudyn, self.model, state)

    def get_state(self) -> State:
        """The state by Exudyn's own kinematics."""
        node, kinds, axes = self.model.node, self._kinds, self.model.axes
        turned = self.model.mbs.GetNodeOutput(node, kinds.RotationMatrix, self._now)
        spin = self.model.mbs.GetNodeOutput(node, kinds.AngularVelocityLocal, self._now)
        quaternion = np.roll(Rotation.from_matrix(turned.reshape(3, 3)).as_quat(), 1)
        position, velocity = self._at_center(kinds.Position), self._at_center(kinds.Velocity)
        return State(axes.of_body(quaternion), axes.in_body(np.array(spin)), position, velocity)

    def _at_center(self, kind: Any) -> Array:
        """What Exudyn has of the centre of mass, in world axes."""
        model = self.model
        return np.array(
            model.mbs.GetObjectOutputBody(
                model.body, kind, model.axes.in_node(model.center).tolist(), self._now
            )
        )

    def forward(self, state: State) -> tuple[Array, Array]:
        """omega-dot (3,), body, and the acceleration of the centre of mass (3,), world.

        The accelerations with which `MainSolverImplicitSecondOrder` begins: the solution of
        ``M q'' + C^T lambda = f``, ``C q'' = 0``. q'' is omega-dot in body axes.
        """
        self.set_state(state)
        self._begin(self.model)
        found = np.array(self.model.mbs.systemData.GetODE2Coordinates_tt())
        return self.model.axes.in_body(found[3:6]), self._at_center(self._kinds.Acceleration)

    def _begin(self, model: ExudynModel) -> Any:
        solver = self._exudyn.MainSolverImplicitSecondOrder()
        solver.InitializeSolver(model.mbs, self._settings)
        return solver

    def inverse(self, state: State, wanted: Acceleration) -> Array:
        """The torque (3,), body axes: ``M q'' - f`` of the body without damping and torques.

        M and f are those of the solver. About the centre of mass, or about the pivot.
        """
        model = self._undriven
        place(self._exudyn, model, state)
        solver, count = self._begin(model), 6
        solver.ComputeMassMatrix(model.mbs)
        mass = np.array(solver.GetSystemMassMatrix())[:count, :count]
        solver.ComputeODE2RHS(model.mbs)
        acting = np.array(solver.GetSystemResidual())[:count]
        q, w = state.orientation, state.angular_velocity
        lifted = cross(wanted.angular, model.center) + cross(w, cross(w, model.center))
        held = model.system.load.pivot is not None
        moving = np.zeros(3) if held else wanted.linear - rotate(q, lifted)
        known = np.concatenate((moving, model.axes.in_node(wanted.angular)))
        found = mass @ known - acting
        torque = model.axes.in_body(found[3:])
        if held:
            return torque
        return torque - cross(model.center, rotate_inverse(q, found[:3]))


def place(exudyn: Any, model: ExudynModel, state: State) -> None:
    """Put a model in the state, at present and at the start of the next run."""
    places, rates = coordinates(model, state)
    data, kinds = model.mbs.systemData, exudyn.ConfigurationType
    for when in (kinds.Initial, kinds.Current):
        data.SetODE2Coordinates(places, when)
        data.SetODE2Coordinates_t(rates, when)
