"""PyBullet behind the protocol: a body as a multibody and, where it is free, by itself."""

from __future__ import annotations

import weakref
from importlib import import_module
from importlib.metadata import version
from typing import Any, Literal

import numpy as np

from omegadot.adapters.one_joint import OneJointAdapter
from omegadot.adapters.protocol import (
    Description,
    Format,
    Setup,
    Trajectory,
    UnsupportedError,
)
from omegadot.adapters.pybullet.integrators import KINDS, Kind, declared_integrators
from omegadot.adapters.pybullet.joint import PyBulletJoint
from omegadot.adapters.pybullet.model import SETTINGS, SWITCHED_OFF, PyBulletModel
from omegadot.adapters.pybullet.stepping import is_finite, run
from omegadot.reference_impl.stepping import kept_steps
from omegadot.reference_impl.system import Acceleration, State, System

CONVENTIONS = (
    "a free body is a base; a pivoted one is a link on a spherical joint to a fixed base, in "
    "reduced coordinates alone",
    "quaternions are (x, y, z, w), world-from-body; places and attitudes are those of the frame of "
    "the inertia: the centre of mass and the principal axes",
    "velocities of a base are (linear, angular), in world axes; that of a spherical joint is omega "
    "in principal axes; calculateInverseDynamics takes (angular, linear) in the base's own axes, "
    "and answers with (force, torque)",
    "torques are applyExternalTorque before each step, of a base in LINK_FRAME or WORLD_FRAME",
    "damping is the jointDamping of the spherical joint; a free body has none that is a torque "
    "-damping * omega",
    "the frame of the inertia of a body in maximal coordinates reads back wrong: the model is read "
    "from the multibody",
)
FEATURES = frozenset(
    {"free", "pivot", "gravity", "torque", "full_inertia", "offset_com", "inverse_dynamics"}
)
LINKS = (
    "https://pybullet.org/",
    "https://github.com/bulletphysics/bullet3",
)


class PyBulletAdapter(OneJointAdapter):
    """PyBullet 3.2. Raises ImportError when PyBullet is not installed."""

    name = "pybullet"

    def __init__(self, setup: Setup = "physics") -> None:
        engine: Any = import_module("pybullet")
        self._engine = engine
        self._setup: Setup = setup
        self._system: System | None = None
        self._clients = {kind: engine.connect(engine.DIRECT) for kind in KINDS}
        for client in self._clients.values():
            weakref.finalize(self, engine.disconnect, client)

    @property
    def description(self) -> Description:
        """PyBullet as it is installed, its schemes those of the system that is loaded."""
        return Description(
            name=self.name,
            version=version("pybullet"),
            integrators=declared_integrators(self._system),
            conventions=CONVENTIONS,
            switched_off=SWITCHED_OFF if self._setup == "physics" else (),
            settings=SETTINGS,
            features=FEATURES,
            licence="Zlib",
            links=LINKS,
        )

    def _built(self, system: System, via: Format | Literal[""]) -> PyBulletJoint:
        self._system = system
        return self._joint_of(system, "multibody")

    def _joint_of(self, system: System, kind: Kind) -> PyBulletJoint:
        client = self._clients[kind]
        model = PyBulletModel(self._engine, client, system, kind, self._setup)
        return PyBulletJoint(self._engine, model)

    def forward_dynamics(self, states: State) -> Acceleration:
        """PyBullet has none. Raises UnsupportedError."""
        raise UnsupportedError("pybullet has no omega-dot at a state")

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """`stepSimulation`, step by step.

        Raises UnsupportedError for an integrator that PyBullet has not, for a pivot in maximal
        coordinates, and where a step turns by 45 degrees.
        """
        loaded: PyBulletJoint = self._loaded()
        kind = next((own for own in KINDS if own == integrator), None)
        if kind is None:
            raise UnsupportedError(f"pybullet has no integrator {integrator!r}.")
        if kind == "maximal" and not loaded.model.free:
            raise UnsupportedError(
                "PyBullet has no joint that holds a point of a body in maximal coordinates but "
                "constraints, which give way; take multibody"
            )
        joint, kept = self._joint_of(loaded.model.system, kind), kept_steps(steps, every)
        if kind == "multibody":
            self._joint = joint  # the world of the one before is gone
        times, start = np.array(kept) * timestep, _numbers(initial)
        joint.set_state(initial)
        if steps == 0 or not is_finite(start):
            first = joint.row()
            rows, seconds = np.full((len(kept), len(first)), np.nan), 0.0
            rows[0] = first
        else:
            rows, seconds = run(self._engine, joint, initial, timestep, kept)
        with np.errstate(over="ignore", invalid="ignore"):  # a diverged run is shown as it is
            return Trajectory(times, joint.states(rows), seconds)


def _numbers(state: State) -> list[float]:
    """All of a state."""
    return [float(number) for values in vars(state).values() for number in np.ravel(values)]
