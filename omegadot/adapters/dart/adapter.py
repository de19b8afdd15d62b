"""DART behind the protocol: its forward and inverse dynamics and its own stepper.

`dart_model` builds the world, `dart_joint` talks to the body in it. The stepper is semi-implicit
Euler: accelerations, then velocities, then positions with the new velocities.
"""

from __future__ import annotations

from time import perf_counter
from typing import Literal

import numpy as np

from omegadot.adapters.dart.joint import DartJoint
from omegadot.adapters.dart.model import SETTINGS, SWITCHED_OFF, DartModel
from omegadot.adapters.one_joint import OneJointAdapter
from omegadot.adapters.protocol import (
    ONE_BODY,
    Description,
    Format,
    Integrator,
    Setup,
    Trajectory,
    UnsupportedError,
)
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import kept_steps
from omegadot.reference_impl.system import State, System

SEMI_IMPLICIT = Integrator(
    "semi-implicit",
    "semi-implicit-euler-short-turns",
    dict(SCHEMES["semi-implicit-euler-short-turns"].orders),
    note="World.step",
    coordinates="origin-world",
)
CONVENTIONS = (
    "FreeJoint velocities are in body axes up to 6.16 and in world axes from 6.17; BallJoint "
    "velocities are in body axes: the adapter requests named frames or uses the Jacobian",
    "orientation is kept as the rotation vector from the joint's frame",
    "spatial vectors are (angular, linear), at the body origin",
    "DART's joint damping is implicit in the step: here -damping * omega is an external torque at "
    "the start of each step, as the applied torques are",
    "rotations of less than 1e-3 rad, those of a step included, are expanded to second order: they "
    "turn by angle**3 / 6 too far",
    "from 6.16.6 a non-finite acceleration is replaced by zero, and from 6.17 a non-finite "
    "transform by the identity: where DART's own coordinates are not finite, the adapter gives NaN",
)
LINKS = (
    "https://github.com/dartsim/dart",
    "https://github.com/dartsim/dart/blob/main/CHANGELOG.md",
    "https://docs.dartsim.org/",
)


class DartAdapter(OneJointAdapter):
    """dartpy 6.16.2 and later."""

    name = "dart"

    def __init__(self, setup: Setup = "physics") -> None:
        import dartpy

        self._engine = dartpy
        self._setup = setup

    @property
    def description(self) -> Description:
        """DART as it is installed."""
        return Description(
            name=self.name,
            version=str(self._engine.__version__),
            integrators=(SEMI_IMPLICIT,),
            conventions=CONVENTIONS,
            switched_off=SWITCHED_OFF if self._setup == "physics" else (),
            settings=SETTINGS,
            features=ONE_BODY,
            licence="BSD-2-Clause",
            links=LINKS,
            importers=("urdf",),  # its reader of MJCF takes no inertia from the file
        )

    def _built(self, system: System, via: Format | Literal[""]) -> DartJoint:
        model = DartModel(self._engine, system, via, setup=self._setup)
        return DartJoint(model, system)

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """`World.step`, the joint's coordinates logged at samples alone.

        Raises UnsupportedError for another integrator than DART's own.
        A run that is no longer finite is not stepped on: its later samples are NaN.
        """
        if integrator != SEMI_IMPLICIT.name:
            raise UnsupportedError(f"dart has no integrator {integrator!r}.")
        joint, kept = self._loaded(), kept_steps(steps, every)
        joint.start(initial, timestep)
        counts = np.diff(kept).tolist()
        began = perf_counter()
        logged = joint.stepper.run(counts)
        seconds = perf_counter() - began
        return Trajectory(np.multiply(kept, timestep), joint.states(logged, len(kept)), seconds)
