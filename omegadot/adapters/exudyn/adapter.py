"""Exudyn behind the protocol: a rigid body, and every dynamic solver that Exudyn has."""

from __future__ import annotations

from importlib import import_module
from importlib.metadata import version
from typing import Any, Literal

import numpy as np

from omegadot.adapters.exudyn.axes import Axes
from omegadot.adapters.exudyn.integrators import declared_integrators, plan_of
from omegadot.adapters.exudyn.joint import ExudynJoint, coordinates, states
from omegadot.adapters.exudyn.model import ExudynModel
from omegadot.adapters.exudyn.nodes import Kind
from omegadot.adapters.exudyn.stepping import (
    SETTINGS,
    is_finite,
    run_by_accuracy,
    run_fixed,
    settings_of,
)
from omegadot.adapters.exudyn.two_axes import run_in_two
from omegadot.adapters.one_joint import OneJointAdapter
from omegadot.adapters.protocol import (
    ONE_BODY,
    Description,
    Format,
    Setup,
    Trajectory,
    UnsupportedError,
    mends,
)
from omegadot.reference_impl.stepping import kept_steps
from omegadot.reference_impl.system import State, System

CONVENTIONS = (
    "a body is an ObjectRigidBody with its node at the body's origin, or at the pivot; its inertia "
    "is about the node, and a step is taken in the node's coordinates",
    "the node NodeRigidBodyRotVecLG keeps a rotation vector, and omega in body axes as its rate; "
    "-EP is the node of Euler parameters, (w, x, y, z), of which the length is a constraint; -Rxyz "
    "has three angles, R = Rx Ry Rz, and their rates, singular where the second is 90 degrees",
    "linear velocities are in world axes, of the node",
    "a pivot is three ObjectConnectorCoordinate, which hold the node's place; for omega-dot with a "
    "factorValue1 above the body's mass, so that rounding leaves the place alone; explicit solvers "
    "take that of the body as if it were free, and are wrong of a pivot off the centre of mass",
    "damping is an ObjectConnectorRigidBodySpringDamper without stiffness to a ground body",
    "torques are LoadTorqueVector, bodyFixed or not",
    "inverse dynamics is M q'' - f, of the solver's mass matrix and right-hand side",
)
SWITCHED_OFF = (
    "the body's axes as the node's: they are exchanged, as a turn near none loses half its digits; "
    "those of a node of three angles are exchanged or not, whichever is far from its singularity",
    "relativeTolerance of error-controlled solvers, which scales the tolerance with coordinates "
    "and rates with their signs, so that it vanishes or grows where these are negative",
    "the tolerances of 1e-8 and 1e-10 of Newton's iterations: 1e-12",
)
LINKS = (
    "https://exudyn.readthedocs.io/",
    "https://github.com/jgerstmayr/EXUDYN",
)


class ExudynAdapter(OneJointAdapter):
    """Exudyn 1.13. Raises ImportError when Exudyn is not installed."""

    name = "exudyn"

    def __init__(self, setup: Setup = "physics") -> None:
        engine: Any = import_module("exudyn")
        import_module("exudyn.itemInterface")
        engine.config.suppressWarnings = True
        engine.config.printToConsole = False
        self._engine = engine
        self._setup: Setup = setup
        self._axes = Axes(turned=mends(setup, "physicsInertia"))

    @property
    def description(self) -> Description:
        """Exudyn as it is installed, the same whatever system is loaded."""
        return Description(
            name=self.name,
            version=version("exudyn"),
            integrators=declared_integrators(),
            conventions=CONVENTIONS,
            switched_off=SWITCHED_OFF if self._setup == "physics" else (),
            settings=SETTINGS,
            features=ONE_BODY,
            licence="LicenseRef-EXUDYN-General-License",
            links=LINKS,
        )

    def _built(self, system: System, via: Format | Literal[""]) -> ExudynJoint:
        self._system = system
        self._models: dict[tuple[Kind, Axes], ExudynModel] = {}
        driven, undriven = (
            ExudynModel(self._engine, system, "rotation-vector", self._axes, loads, stepped=False)
            for loads in (True, False)
        )
        return ExudynJoint(self._engine, driven, undriven)

    def _model(self, kind: Kind, axes: Axes | None = None) -> ExudynModel:
        """The model with this kind of node, in these axes or the usual ones, which is kept."""
        key = kind, axes or self._axes
        if key not in self._models:
            self._models[key] = ExudynModel(self._engine, self._system, *key)
        return self._models[key]

    def run(
        self,
        initial: State,
        integrator: str,
        timestep: float,
        steps: int,
        every: int,
        accuracy: float | None = None,
    ) -> Trajectory:
        """`SolveDynamic`, once where steps are fixed, else from sample to sample.

        In two axes of an Rxyz node it is a call for some steps each.

        Raises UnsupportedError for an integrator that Exudyn has not.
        """
        self._loaded()
        plan = plan_of(integrator)
        if plan is None:
            raise UnsupportedError(f"exudyn has no integrator {integrator!r}.")
        model, kept = self._model(plan.node), kept_steps(steps, every)
        times, start = np.array(kept) * timestep, np.hstack(coordinates(model, initial))
        if steps == 0 or not is_finite(start):
            rows, seconds = np.full((len(kept), len(start)), np.nan), 0.0
        elif plan.node == "rxyz" and mends(self._setup, "physicsInertia"):
            own = settings_of(self._engine, plan, self._setup)
            both = [self._model(plan.node, axes) for axes in (self._axes, self._axes.others)]
            found, seconds = run_in_two(self._engine, both, own, initial, timestep, steps)
            return Trajectory(times, found[kept], seconds)
        elif plan.fixed:
            own = settings_of(self._engine, plan, self._setup)
            rows, seconds = run_fixed(self._engine, model, own, initial, timestep, kept)
        else:
            own = settings_of(self._engine, plan, self._setup, accuracy)
            ends = np.arange(steps + 1) * timestep  # where steps have to end
            rows, seconds = run_by_accuracy(self._engine, model, own, initial, ends)
            rows = rows[kept]
        rows[0] = start
        with np.errstate(over="ignore", invalid="ignore"):  # a diverged run is shown as it is
            return Trajectory(times, states(model, rows), seconds)
