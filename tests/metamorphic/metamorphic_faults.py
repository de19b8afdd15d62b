"""Wrong engines that break one relation each; `wrong.py` has the others."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).parent.parent / "wrong_engines"))
from wrong import DiagonalInertia, FallsAsleep, OmegaDotInWorld, Wrong

from omegadot.reference_impl.inertia import parallel_axis
from omegadot.reference_impl.system import Acceleration, State, System

__all__ = ["DiagonalInertia", "FallsAsleep", "OmegaDotInWorld"]


class GravityAlwaysDown(Wrong):
    """Takes the size of gravity, and lets it point along -z."""

    def load(self, system: System) -> None:
        down = np.array([0.0, 0.0, -float(np.linalg.norm(system.load.gravity))])
        super().load(replace(system, load=replace(system.load, gravity=down)))


class SortedMoments(Wrong):
    """Takes the principal moments in rising order, as eigenvalues come, with the axes left out."""

    def load(self, system: System) -> None:
        sorted_moments = np.diag(np.linalg.eigvalsh(system.body.inertia))
        body = replace(system.body, inertia=sorted_moments)
        super().load(replace(system, bodies=(body,)))


class AirDrag(Wrong):
    """Slows the centre of mass down by 1e-6 of its velocity a second."""

    def forward_dynamics(self, states: State) -> Acceleration:
        found = super().forward_dynamics(states)
        return Acceleration(found.angular, found.linear - 1e-6 * states.linear_velocity)


class BearingFriction(Wrong):
    """Slows the rotation down by 1e-6 of its rate a second."""

    def forward_dynamics(self, states: State) -> Acceleration:
        found = super().forward_dynamics(states)
        return Acceleration(found.angular - 1e-6 * states.angular_velocity, found.linear)


class VelocityClamp(Wrong):
    """Keeps every component of omega below 10 rad/s."""

    def forward_dynamics(self, states: State) -> Acceleration:
        slow = np.clip(states.angular_velocity, -10.0, 10.0)
        return super().forward_dynamics(replace(states, angular_velocity=slow))


class InertiaAboutTheOrigin(Wrong):
    """Adds the parallel axis to an inertia that is about the centre of mass."""

    def load(self, system: System) -> None:
        body = system.body
        about = body.inertia + parallel_axis(body.mass, body.center_of_mass)
        super().load(replace(system, bodies=(replace(body, inertia=about),)))
