"""Basilisk behind the protocol: a spacecraft, and every integrator for motions without noise."""

from __future__ import annotations

from importlib import import_module
from importlib.metadata import version
from types import SimpleNamespace
from typing import Any, Literal

import numpy as np

from omegadot.adapters.basilisk.hub import BasiliskHub, place, row_of, states
from omegadot.adapters.basilisk.integrators import Plan, declared_integrators, plan_of
from omegadot.adapters.basilisk.model import BasiliskModel
from omegadot.adapters.basilisk.stepping import (
    is_finite,
    nanoseconds,
    run_directly,
    run_simulation,
)
from omegadot.adapters.one_joint import OneJointAdapter
from omegadot.adapters.protocol import (
    Description,
    Format,
    Setup,
    Trajectory,
    UnsupportedError,
    mends,
)
from omegadot.reference_impl.stepping import kept_steps
from omegadot.reference_impl.system import Acceleration, Array, State, System

CONVENTIONS = (
    "attitudes are modified Rodrigues parameters sigma, world-from-body; after each step the "
    "shorter ones are taken",
    "omega is in body axes, place and velocity are in world axes; a step is taken in those of the "
    "body's origin, Basilisk's point B",
    "gravity is the field of a point mass 2e25 m away, as Basilisk has no uniform one",
    "torques are ExtForceTorque, in body axes; Basilisk has none in world axes, no damping of "
    "omega and no pivot of a spacecraft",
    "omega-dot is by Spacecraft.equationsOfMotion; omegaDot_BN_B of its message is a difference "
    "quotient over the step before",
    "times are whole nanoseconds; steps that are none are taken by calls of the integrator",
)
SWITCHED_OFF = ("the absolute tolerance of 1e-8 of error-controlled integrators: the accuracy",)
SETTINGS = ("setAbsoluteTolerance",)
FEATURES = frozenset(
    {"free", "gravity", "torque", "full_inertia", "offset_com", "forward_dynamics"}
)
LINKS = (
    "https://avslab.github.io/basilisk/",
    "https://github.com/AVSLab/basilisk",
)
# Those of Basilisk that are used; its SimulationBaseClass imports matplotlib.
PARTS = (
    *("architecture.bskLogging", "architecture.messaging", "architecture.sim_model"),
    *("architecture.sys_model_task", "simulation.extForceTorque", "simulation.gravityEffector"),
    *("simulation.spacecraft", "simulation.svIntegrators"),
)


class BasiliskAdapter(OneJointAdapter):
    """Basilisk 2.12. Raises ImportError when Basilisk is not installed."""

    name = "basilisk"

    def __init__(self, setup: Setup = "physics") -> None:
        parts = {part: vars(import_module(f"Basilisk.{part}")) for part in PARTS}
        self._engine: Any = SimpleNamespace(
            **{k: v for own in parts.values() for k, v in own.items()}
        )
        # The one that is raised; the classes of this name in other modules are no exceptions.
        self._engine.Refusal = parts["architecture.bskLogging"]["BasiliskError"]
        self._engine.setDefaultLogLevel(self._engine.BSK_SILENT)
        self._setup = setup

    @property
    def description(self) -> Description:
        """Basilisk as it is installed, the same whatever system is loaded."""
        return Description(
            name=self.name,
            version=version("bsk"),
            integrators=declared_integrators(),
            conventions=CONVENTIONS,
            switched_off=SWITCHED_OFF if self._setup == "physics" else (),
            settings=SETTINGS,
            features=FEATURES,
            licence="ISC",
            links=LINKS,
        )

    def _built(self, system: System, via: Format | Literal[""]) -> BasiliskHub:
        self._system = system
        return BasiliskHub(BasiliskModel(self._engine, system))

    def inverse_dynamics(self, states: State, acceleration: Acceleration) -> Array:
        """Basilisk has none. Raises UnsupportedError."""
        raise UnsupportedError("basilisk has no inverse dynamics")

    def run(
        self,
        initial: State,
        integrator: str,
        timestep: float,
        steps: int,
        every: int,
        accuracy: float | None = None,
    ) -> Trajectory:
        """One simulation, from a spacecraft of its own.

        Raises UnsupportedError for an integrator that Basilisk has not.
        """
        self._loaded()
        plan = plan_of(integrator)
        if plan is None:
            raise UnsupportedError(f"basilisk has no integrator {integrator!r}.")
        kept, model = kept_steps(steps, every), self._model(plan, accuracy)
        whole, start = nanoseconds(timestep), row_of(model, initial)
        if steps == 0 or not is_finite(start):  # Basilisk refuses what is not
            rows, seconds = np.full((len(kept), len(start)), np.nan), 0.0
            rows[0] = start
        else:
            place(model, initial)
            rows, seconds = (
                run_simulation(self._engine, model, whole, kept)
                if whole
                else run_directly(model, timestep, kept)
            )
        with np.errstate(over="ignore", invalid="ignore"):  # a diverged run is shown as it is
            return Trajectory(np.array(kept) * timestep, states(model, rows), seconds)

    def _model(self, plan: Plan, accuracy: float | None) -> BasiliskModel:
        relative = None if plan.fixed else accuracy
        absolute = relative if mends(self._setup, "setAbsoluteTolerance") else None
        return BasiliskModel(self._engine, self._system, plan.kind, relative, absolute)
