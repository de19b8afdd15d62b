"""OpenSim behind the protocol: a body on a joint, and every integrator of its `Manager`."""

from __future__ import annotations

from importlib import import_module
from importlib.metadata import version
from typing import Any, Literal

import numpy as np

from omegadot.adapters.one_joint import OneJointAdapter
from omegadot.adapters.opensim.charts import TURNED, WORLD, Chart
from omegadot.adapters.opensim.integrators import Plan, declared_integrators, plan_of
from omegadot.adapters.opensim.joint import OpenSimJoint, coordinates, states
from omegadot.adapters.opensim.model import OpenSimModel
from omegadot.adapters.opensim.stepping import OpenSimStepper, is_finite
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
from omegadot.reference_impl.system import Array, State, System

CONVENTIONS = (
    "a free body has a FreeJoint at the body's origin, a pivoted one a BallJoint at the pivot; "
    "both keep three angles, R = Rx Ry Rz, singular where the second is 90 degrees; Simbody's "
    "quaternions cannot be chosen in Python",
    "velocities are (angular, linear), both in the axes of the joint's frame in the ground, of the "
    "body's origin; a step is taken in the angles, and in omega in these axes",
    "damping is a SpringGeneralizedForce without stiffness on each of the joint's speeds, which "
    "are omega and not the angles' rates",
    "torques are PrescribedForce, forceIsGlobal or not",
    "inverse dynamics is InverseDynamicsSolver, with gravity as the only force",
)
SWITCHED_OFF = (
    "the ground's axes as the joint's, wherever these are near the angles' singularity: the "
    "joint's frame is then turned by 90 degrees about z, from one step, or sample, to the next",
    "the accuracy of 1e-3 to which Verlet's fixed steps solve their equation: 1e-12",
)
SETTINGS = ("orientationInParent", "setIntegratorAccuracy")
LINKS = (
    "https://opensim.stanford.edu/",
    "https://github.com/opensim-org/opensim-core",
    "https://simbody.github.io/",
)


class OpenSimAdapter(OneJointAdapter):
    """OpenSim 4.6. Raises ImportError when OpenSim is not installed."""

    name = "opensim"

    def __init__(self, setup: Setup = "physics") -> None:
        engine: Any = import_module("opensim")
        engine.Logger.setLevelString("Off")
        self._engine = engine
        self._setup = setup
        self._charts = (WORLD, TURNED) if mends(setup, "orientationInParent") else (WORLD,)

    @property
    def description(self) -> Description:
        """OpenSim as it is installed, the same whatever system is loaded."""
        return Description(
            name=self.name,
            version=version("opensim"),
            integrators=declared_integrators(self._setup == "physics"),
            conventions=CONVENTIONS,
            switched_off=SWITCHED_OFF if self._setup == "physics" else (),
            settings=SETTINGS,
            features=ONE_BODY,
            licence="Apache-2.0",
            links=LINKS,
        )

    def _built(self, system: System, via: Format | Literal[""]) -> OpenSimJoint:
        driven, undriven = (
            {chart: OpenSimModel(self._engine, system, chart, loads) for chart in self._charts}
            for loads in (True, False)
        )
        return OpenSimJoint(self._engine, driven, undriven)

    def run(
        self,
        initial: State,
        integrator: str,
        timestep: float,
        steps: int,
        every: int,
        accuracy: float | None = None,
    ) -> Trajectory:
        """`Manager.integrate` from step to step, or from sample to sample.

        Raises UnsupportedError for an integrator that OpenSim has not.
        """
        joint: OpenSimJoint = self._loaded()
        plan = plan_of(integrator)
        if plan is None:
            raise UnsupportedError(f"opensim has no integrator {integrator!r}.")
        kept, chart = kept_steps(steps, every), joint.chart_for(initial)
        times, start = np.array(kept) * timestep, coordinates(joint.system, chart, initial)
        if steps == 0 or not is_finite(start):
            rows, charts, seconds = np.full((len(kept), len(start)), np.nan), [chart], 0.0
            rows[0], charts = start, charts * len(kept)
        else:
            own = accuracy or self._solves(plan)
            stepper = OpenSimStepper(self._engine, joint.models, plan, timestep, own)
            ends = np.arange(1, steps + 1) * timestep
            rows, charts, seconds = stepper.run(chart, start, ends)
            rows, charts = rows[kept], [charts[n] for n in kept]
        with np.errstate(over="ignore", invalid="ignore"):  # a diverged run is shown as it is
            return Trajectory(times, _states(joint.system, charts, rows), seconds)

    def _solves(self, plan: Plan) -> float | None:
        return plan.solves if plan.solves and mends(self._setup, "setIntegratorAccuracy") else None


def _states(system: System, charts: list[Chart], rows: Array) -> State:
    """The states of coordinates, each in its chart."""
    turned = np.array([chart.turned for chart in charts])[:, None]
    one, other = (vars(states(system, chart, rows)) for chart in (WORLD, TURNED))
    return State(*(np.where(turned, other[name], one[name]) for name in one))
