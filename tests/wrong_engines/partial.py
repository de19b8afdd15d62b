"""Engines that have a part of the protocol alone, or fail at a part of it.

Each steps a free body by semi-implicit Euler; what it does not declare it does not answer.
"""

from __future__ import annotations

import os
from dataclasses import replace
from typing import Any

from omegadot.adapters.protocol import Description, Integrator, Trajectory, UnsupportedError
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import Acceleration, Array, State, System

EULER = "semi-implicit-euler"
VARIABLE = "PARTIAL_ENGINE"  # its release, as an interpreter sets it


class _Partial(ReferenceAdapter):
    dynamics: frozenset[str] = frozenset({"forward_dynamics", "inverse_dynamics"})
    steps = True

    @property
    def description(self) -> Description:
        euler = Integrator(EULER, EULER, dict(SCHEMES[EULER].orders))
        return replace(
            super().description,
            version=os.environ.get(VARIABLE, "1.0"),
            integrators=(euler,) if self.steps else (),
            features=frozenset({"free", "full_inertia", "offset_com"}) | self.dynamics,
        )

    def load(self, system: System) -> None:
        load = system.load
        if load.pivot is not None or load.damping:
            raise UnsupportedError("free bodies without damping only")
        super().load(system)

    def forward_dynamics(self, states: State) -> Acceleration:
        if "forward_dynamics" not in self.dynamics:
            raise AttributeError("forward_dynamics")
        return super().forward_dynamics(states)

    def inverse_dynamics(self, states: State, acceleration: Acceleration) -> Array:
        if "inverse_dynamics" not in self.dynamics:
            raise AttributeError("inverse_dynamics")
        return super().inverse_dynamics(states, acceleration)


class NoInverse(_Partial):
    dynamics = frozenset({"forward_dynamics"})


class NoForward(_Partial):
    dynamics = frozenset({"inverse_dynamics"})


class NoDynamics(_Partial):
    dynamics = frozenset()


class NoIntegrator(_Partial):
    steps = False


class NoIntegratorNoCoupling(NoIntegrator):
    """It leaves the gyroscopic term out."""

    def forward_dynamics(self, states: State) -> Acceleration:
        still = replace(states, angular_velocity=0.0 * states.angular_velocity)
        return super().forward_dynamics(still)


class NoIntegratorOnceLoaded(_Partial):
    def load(self, system: System) -> None:
        super().load(system)
        self.steps = False


class RunRaises(_Partial):
    def run(self, *_: Any) -> Trajectory:
        raise ValueError("no licence")


class ModelOnly(NoIntegrator):
    """Nothing of its motion can be requested."""

    dynamics = frozenset()


class InverseOnly(NoIntegrator):
    dynamics = frozenset({"inverse_dynamics"})
