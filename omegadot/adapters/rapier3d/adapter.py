"""Rapier behind the protocol: a free body, or one on a spherical joint in reduced coordinates."""

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
from omegadot.adapters.rapier3d.integrators import STEP, declared_integrators
from omegadot.adapters.rapier3d.model import SETTINGS, SWITCHED_OFF, RapierModel
from omegadot.adapters.rapier3d.stepping import omega_dot, run
from omegadot.reference_impl.motion import center_of_mass_acceleration
from omegadot.reference_impl.rotations import rotate_inverse
from omegadot.reference_impl.stepping import kept_steps
from omegadot.reference_impl.system import Acceleration, Array, State, System

CONVENTIONS = (
    "a free body is by itself; a pivoted one is on a SphericalJoint of a MultibodyJointSet, to a "
    "fixed body: its coordinates are the attitude and omega",
    "Rotation3 is made of (w, x, y, z), world-from-body, and its quaternion reads (x, y, z, w)",
    "a body's translation is that of its origin, its linvel that of its centre of mass; all "
    "velocities are in world axes, that of a spherical joint in those of the fixed body",
    "the inertia is three principal moments about the centre of mass, and the rotation of their "
    "axes",
    "a torque is in world axes and acts until it is reset: a torque in body axes is turned at the "
    "start of each step",
    "damping is that of the multibody, a torque of its joint; a free body has none that is a "
    "torque -damping * omega",
    "omega-dot of a pivoted body is generalized_acceleration of a step that changes no number; a "
    "free body has none",
)
FEATURES = frozenset({"free", "pivot", "gravity", "torque", "full_inertia", "offset_com"})
OF_PIVOTED = frozenset({"forward_dynamics"})
LINKS = (
    "https://rapier.rs/",
    "https://github.com/dimforge/rapier",
)


class RapierAdapter(OneJointAdapter):
    """Rapier 0.36 in single precision. Raises ImportError when rapier3d is not installed."""

    name = "rapier3d"

    def __init__(self, setup: Setup = "physics") -> None:
        self._engine: Any = import_module("rapier3d")
        self._setup: Setup = setup
        self._system: System | None = None

    @property
    def description(self) -> Description:
        """Rapier as it is installed; schemes and features are of the system that is loaded."""
        free = self._system is not None and self._system.load.pivot is None
        return Description(
            name=self.name,
            version=version("rapier3d"),
            integrators=declared_integrators(self._system),
            precision="float32",
            conventions=CONVENTIONS,
            switched_off=SWITCHED_OFF if self._setup == "physics" else (),
            settings=SETTINGS,
            features=FEATURES if free else FEATURES | OF_PIVOTED,
            licence="Apache-2.0",
            links=LINKS,
        )

    def _built(self, system: System, via: Format | Literal[""]) -> RapierModel:
        self._system = system
        return self._anew(system)

    def _anew(self, system: System) -> RapierModel:
        return RapierModel(self._engine, system, self._setup)

    def set_state(self, state: State) -> None:
        """Put a new body in the state."""
        self._joint = model = self._anew(self._loaded().system)
        model.set_state(state)

    def get_state(self) -> State:
        """The present state, in the project's frames."""
        model: RapierModel = self._loaded()
        return model.states(np.array(model.row())[None])[0]

    def forward_dynamics(self, states: State) -> Acceleration:
        """Rapier's omega-dot of a pivoted body; its centre of mass follows from it.

        Raises UnsupportedError for a free body, of which Rapier has none.
        """
        model: RapierModel = self._loaded()
        system = model.system
        if model.free:
            raise UnsupportedError("rapier3d has no omega-dot at a state of a free body")
        count = len(states.angular_velocity)
        found = np.array([omega_dot(self._anew(system), states[n]) for n in range(count)])
        angular = rotate_inverse(states.orientation, found)
        return Acceleration(angular, center_of_mass_acceleration(system, states, angular))

    def inverse_dynamics(self, states: State, acceleration: Acceleration) -> Array:
        """Rapier has none. Raises UnsupportedError."""
        raise UnsupportedError("rapier3d has no inverse dynamics")

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """`PhysicsWorld.step`, step by step.

        Raises UnsupportedError for an integrator that Rapier has not.
        """
        loaded: RapierModel = self._loaded()
        if integrator != STEP:
            raise UnsupportedError(f"rapier3d has no integrator {integrator!r}.")
        kept = kept_steps(steps, every)
        # Nothing is left of an earlier run.
        self._joint = model = self._anew(loaded.system)
        if is_finite(initial):
            rows, seconds = run(model, initial, timestep, kept)
            found = model.states(rows)
        else:
            found, seconds = lost(initial, len(kept)), 0.0
        return Trajectory(np.array(kept) * timestep, found, seconds)
