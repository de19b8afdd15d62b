"""An engine in made-up releases, and interpreters that have them.

Until 1.1 it steps Euler's scheme, until 1.3 a Runge-Kutta of order 2 in attitude, then one of
order 4. From 1.2 on its velocities are in world axes, from 1.4 on it has a second integrator. 1.5
dies as it starts, 1.6 cannot be imported, 1.7 dies when it is queried anything, and 1.8 declares
what it does not do.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

from omegadot.adapters.protocol import (
    Description,
    Integrator,
    Setup,
    Trajectory,
    UnsupportedError,
)
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import State, System

VARIABLE = "VERSIONED_ENGINE"
TARGET = f"{Path(__file__)}:VersionedAdapter"
ALL = ("1.0", "1.1", "1.2", "1.3", "1.4")


def interpreter(folder: Path, version: str) -> Path:
    """A program that is this Python with a release of the engine."""
    path = folder / f"python-{version}"
    path.write_text(f'#!/bin/sh\nexport {VARIABLE}={version}\nexec "{sys.executable}" "$@"\n')
    path.chmod(0o755)
    return path


def arguments(folder: Path, *versions: str) -> list[str]:
    """The arguments that give each release its interpreter."""
    return [f"{version}={interpreter(folder, version)}" for version in versions]


class VersionedAdapter(ReferenceAdapter):
    def __init__(self, setup: Setup = "physics") -> None:
        super().__init__(setup)
        self.version = os.environ[VARIABLE]
        self.number = int(self.version.split(".")[1])
        if self.number == 5:
            os.abort()
        if self.number == 6:
            raise ImportError("libold.so: cannot open shared object file")

    def _scheme(self) -> str:
        if self.number <= 1:
            return "semi-implicit-euler"
        return "lie-rk4-naive" if self.number <= 3 else "lie-rk4"

    @property
    def description(self) -> Description:
        names = {"step": self._scheme()}
        if self.number >= 4:
            names["second"] = "semi-implicit-euler"
        if self.number == 8:
            names["second"] = "lie-rk4"
        integrators = tuple(
            Integrator(name, scheme, dict(SCHEMES[scheme].orders)) for name, scheme in names.items()
        )
        features = frozenset({"free", "full_inertia", "offset_com", "forward_dynamics"})
        return Description("versioned", self.version, integrators, features=features)

    def native(self) -> dict[str, dict[str, str]]:
        axes = "body axes" if self.number < 2 else "world axes"
        return {"conventions": {"velocity frame": axes}, "defaults": {"timestep": "0.001"}}

    def load(self, system: System) -> None:
        if self.number == 7:
            os.abort()
        if system.load.pivot is not None or system.load.damping:
            raise UnsupportedError("free bodies without damping only")
        super().load(system)

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        name = self._scheme() if integrator == "step" else "semi-implicit-euler"
        how = (SCHEMES[name], self.system)
        return Trajectory(*step_body(*how, initial, timestep, steps, every))
