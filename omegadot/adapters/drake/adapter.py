"""Drake behind the protocol: a `MultibodyPlant`, and every integrator of its `Simulator`."""

from __future__ import annotations

from importlib import import_module
from importlib.metadata import version
from types import SimpleNamespace
from typing import Any, Literal

import numpy as np

from omegadot.adapters.drake.integrators import declared_integrators, plan_of
from omegadot.adapters.drake.joint import DrakeJoint
from omegadot.adapters.drake.model import SETTINGS, SWITCHED_OFF, DrakeModel, Stepping
from omegadot.adapters.drake.stepping import (
    NO_OTHER_JOINT,
    DrakeStepper,
    is_finite,
    refuse_unresolved,
)
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
    "quaternions are (w, x, y, z), world-from-body, and are not made unit again after a step",
    "velocities are (angular, linear), both in world axes, of the body's frame; a step is taken in "
    "omega in world axes",
    "a free body has a QuaternionFloatingJoint at the body's origin",
    "a pivoted body has a BallRpyJoint at the pivot: roll, pitch and yaw, R = Rz Ry Rx; Drake has "
    "no ball joint without their singularity, and refuses to step where |cos(pitch)| < 1e-3",
    "damping is that of the joint: implicit in a discrete plant's step",
    "a torque in body axes is that of a Propeller without thrust, a torque in world axes is given "
    "to applied_generalized_force",
)
LINKS = (
    "https://drake.mit.edu/",
    "https://drake.mit.edu/doxygen_cxx/classdrake_1_1multibody_1_1_multibody_plant.html",
    "https://drake.mit.edu/doxygen_cxx/group__integrators.html",
    "https://github.com/RobotLocomotion/drake",
    NO_OTHER_JOINT,
)
# Those of pydrake that are used; pydrake.all takes three times as long to import.
PARTS = (
    *("common.eigen_geometry", "math", "multibody.parsing", "multibody.plant", "multibody.tree"),
    *("systems.analysis", "systems.framework"),
)


class DrakeAdapter(OneJointAdapter):
    """Drake 1.51. Raises ImportError when Drake is not installed."""

    name = "drake"

    def __init__(self, setup: Setup = "physics") -> None:
        parts = {part: vars(import_module(f"pydrake.{part}")) for part in PARTS}
        self._engine: Any = SimpleNamespace(
            **{k: v for own in parts.values() for k, v in own.items()}
        )
        self._setup = setup
        self._pivoted = False

    @property
    def description(self) -> Description:
        """Drake as it is installed, and what it steps of a free or of a pivoted body."""
        return Description(
            name=self.name,
            version=version("drake"),
            integrators=declared_integrators(self._pivoted),
            conventions=CONVENTIONS,
            switched_off=SWITCHED_OFF if self._setup == "physics" else (),
            settings=SETTINGS,
            features=ONE_BODY,
            licence="BSD-3-Clause",
            links=LINKS,
            importers=("urdf", "mjcf"),
        )

    def _built(self, system: System, via: Format | Literal[""]) -> DrakeJoint:
        self._system, self._via = system, via
        self._pivoted = system.load.pivot is not None
        self._models: dict[Stepping, DrakeModel] = {}
        return DrakeJoint(self._engine, self._model(Stepping()))

    def _model(self, stepping: Stepping) -> DrakeModel:
        """The model for this stepping; the last one of each kind is kept."""
        if stepping not in self._models:
            self._models = {Stepping(): self._models[Stepping()]} if self._models else {}
            self._models[stepping] = DrakeModel(self._engine, self._system, self._via, stepping)
        return self._models[stepping]

    def run(
        self,
        initial: State,
        integrator: str,
        timestep: float,
        steps: int,
        every: int,
        accuracy: float | None = None,
    ) -> Trajectory:
        """`Simulator.AdvanceTo` from sample to sample.

        Raises UnsupportedError for an integrator that Drake has not, and for a motion that takes a
        ball joint to its singularity, or nearer to it than a fixed step turns.
        """
        joint, kept = self._loaded(), kept_steps(steps, every)
        plan = plan_of(integrator)
        if plan is None:
            raise UnsupportedError(f"drake has no integrator {integrator!r}.")
        times, start = np.array(kept) * timestep, joint.coordinates(initial)
        if steps == 0 or not is_finite(start):  # Drake raises SystemExit at NaN
            rows = np.full((len(kept), len(start)), np.nan)
            rows[0] = start
            return Trajectory(times, joint.states(rows), 0.0)
        stepper = DrakeStepper(self._engine, self._model(plan.stepping(timestep)), start)
        if plan.scheme:
            own = stepper.integrate(plan.scheme, timestep if plan.fixed else times[-1])
            own.set_fixed_step_mode(plan.fixed)
            wanted = plan.solves if mends(self._setup, "set_target_accuracy") else 0.0
            if accuracy or wanted:
                own.set_target_accuracy(accuracy or wanted)
        each = self._pivoted or not plan.fixed  # stop at every step, or where steps have to end
        rows, seconds = stepper.run(np.arange(1, steps + 1) * timestep if each else times[1:])
        if self._pivoted and plan.fixed:
            refuse_unresolved(rows, timestep)
        rows = rows[kept] if each else rows
        with np.errstate(over="ignore", invalid="ignore"):  # a diverged run is shown as it is
            return Trajectory(times, joint.states(rows), seconds)
