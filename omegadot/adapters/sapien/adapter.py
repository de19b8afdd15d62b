"""SAPIEN behind the protocol: a free body in PhysX, on the processor and without rendering."""

from __future__ import annotations

from importlib import import_module
from importlib.metadata import version
from typing import Any, Literal

import numpy as np

from omegadot.adapters.lost_run import is_finite, lost
from omegadot.adapters.one_joint import OneJointAdapter
from omegadot.adapters.protocol import (
    Description,
    Format,
    Setup,
    Trajectory,
    UnsupportedError,
)
from omegadot.adapters.sapien.integrators import STEP, declared_integrators
from omegadot.adapters.sapien.model import SETTINGS, SWITCHED_OFF, SapienModel
from omegadot.adapters.sapien.stepping import run
from omegadot.reference_impl.stepping import kept_steps
from omegadot.reference_impl.system import Acceleration, Array, State, System

CONVENTIONS = (
    "quaternions are (w, x, y, z), world-from-body",
    "a component's pose is that of its origin, its linear velocity that of its centre of mass; all "
    "velocities are in world axes",
    "the inertia is three principal moments about the centre of mass, along the axes of "
    "cmass_local_pose",
    "a torque is add_force_torque, in world axes, and acts during one step: a torque in body axes "
    "is turned at the start of each step",
    "the gyroscopic term is on (PxRigidBodyFlag::eENABLE_GYROSCOPIC_FORCES), and has no switch",
)
FEATURES = frozenset({"free", "gravity", "torque", "full_inertia", "offset_com"})
LINKS = (
    "https://sapien.ucsd.edu/",
    "https://github.com/haosulab/SAPIEN",
    "https://github.com/NVIDIA-Omniverse/PhysX",
)


class SapienAdapter(OneJointAdapter):
    """SAPIEN 3.0, by PhysX 5.3.1. Raises ImportError when SAPIEN is not installed."""

    name = "sapien"

    def __init__(self, setup: Setup = "physics") -> None:
        self._engine: Any = import_module("sapien")
        self._setup: Setup = setup
        self._system: System | None = None

    @property
    def description(self) -> Description:
        """SAPIEN as it is installed, its scheme that of the system that is loaded."""
        return Description(
            name=self.name,
            version=version("sapien"),
            integrators=declared_integrators(self._system, self._setup),
            precision="float32",
            conventions=CONVENTIONS,
            switched_off=SWITCHED_OFF if self._setup == "physics" else (),
            settings=SETTINGS,
            features=FEATURES,
            licence="Apache-2.0 AND BSD-3-Clause",  # of SAPIEN, and of PhysX in it
            links=LINKS,
        )

    def _built(self, system: System, via: Format | Literal[""]) -> SapienModel:
        self._system = system
        return SapienModel(self._engine, system, self._setup)

    def forward_dynamics(self, states: State) -> Acceleration:
        """SAPIEN has none of a rigid body. Raises UnsupportedError."""
        raise UnsupportedError("sapien has no omega-dot at a state")

    def inverse_dynamics(self, states: State, acceleration: Acceleration) -> Array:
        """SAPIEN has none of a rigid body. Raises UnsupportedError."""
        raise UnsupportedError("sapien has no inverse dynamics of a rigid body")

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """`PhysxCpuSystem.step`, step by step.

        Raises UnsupportedError for an integrator that SAPIEN has not.
        """
        loaded: SapienModel = self._loaded()
        if integrator != STEP:
            raise UnsupportedError(f"sapien has no integrator {integrator!r}.")
        kept = kept_steps(steps, every)
        # Nothing is left of an earlier run.
        self._joint = model = SapienModel(self._engine, loaded.system, self._setup)
        if is_finite(initial):
            rows, seconds = run(model, initial, timestep, kept)
            found = model.states(rows)
        else:
            found, seconds = lost(initial, len(kept)), 0.0
        return Trajectory(np.array(kept) * timestep, found, seconds)
