"""Pinocchio behind the protocol: its ABA and RNEA, and the reference's schemes stepping its ABA.

Pinocchio computes dynamics and has no stepper, so every integrator here is named
``aba+<scheme of the reference>``. `pinocchio_joint` holds the model and the joint coordinates.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from omegadot.adapters.one_joint import OneJointAdapter
from omegadot.adapters.pinocchio.joint import PinocchioJoint
from omegadot.adapters.pinocchio.model import build_model, importers, read_model
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
from omegadot.reference_impl.stepping import step_through
from omegadot.reference_impl.system import Acceleration, State, System

PREFIX = "aba+"
NOTE = "the reference's scheme over Pinocchio's ABA, not a stepper of Pinocchio's own"

CONVENTIONS = (
    "quaternions are (x, y, z, w) in q",
    "a free body has a free-flyer joint at the body origin: its velocity is the spatial velocity "
    "(linear, angular) of that origin in body axes, its acceleration the spatial one",
    "a pivoted body has a spherical joint at the pivot: its velocity is omega in body axes",
    "no stepper: the reference's schemes step pinocchio.aba (convention LOCAL) and "
    "pinocchio.integrate in these coordinates",
    "computeABADerivatives works about the world's origin and loses digits with the distance from "
    "it: its result does not depend on the place, so a free body is put at the origin for it",
    "no damping inside aba: -damping * omega and the applied torques are added to the joint torque "
    "at every evaluation",
)
LINKS = (
    "https://github.com/stack-of-tasks/pinocchio",
    "https://gepettoweb.laas.fr/doc/stack-of-tasks/pinocchio/master/doxygen-html/",
)

# The reference's other schemes are those of other engines' steppers; no user loops them here.
LOOPED = (
    "semi-implicit-euler",
    "linearly-implicit-euler",
    "rk4-quaternion",
    "lie-rk4",
    "lie-rk4-naive",
    "implicit-midpoint",
)


class PinocchioAdapter(OneJointAdapter):
    """Pinocchio 3.4 and later. Nothing in it spoils physics, so both setups are the same."""

    name = "pinocchio"

    def __init__(self, setup: Setup = "physics") -> None:
        import pinocchio

        self._engine = pinocchio

    @property
    def description(self) -> Description:
        """Pinocchio as it is installed."""
        integrators = tuple(
            Integrator(
                PREFIX + name,
                name,
                dict(SCHEMES[name].orders),
                note=NOTE,
                coordinates="body-spatial",
            )
            for name in LOOPED
        )
        return Description(
            name=self.name,
            version=str(self._engine.__version__),
            integrators=integrators,
            conventions=CONVENTIONS,
            features=ONE_BODY,
            licence="BSD-2-Clause",
            links=LINKS,
            importers=importers(self._engine),
        )

    def _built(self, system: System, via: Format | Literal[""]) -> PinocchioJoint:
        model = read_model(self._engine, system, via) if via else build_model(self._engine, system)
        return PinocchioJoint(self._engine, system, model)

    def forward_dynamics(self, states: State) -> Acceleration:
        """`pinocchio.aba` at n states."""
        joint = self._loaded()
        rows = zip(*joint.coordinates(states), strict=True)
        answers = np.array([joint.forward(q, v) for q, v in rows])
        return Acceleration(answers[:, 0], answers[:, 1])

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """Step a scheme of the reference over `aba`. Raises UnsupportedError for other names."""
        name = integrator.removeprefix(PREFIX)
        if name not in LOOPED or not integrator.startswith(PREFIX):
            raise UnsupportedError(f"pinocchio has no integrator {integrator!r}.")
        scheme = SCHEMES[name]
        joint = self._loaded()
        q, v = joint.coordinates(initial)
        found = step_through(scheme, joint.motion, q, v, timestep, steps, every)
        return Trajectory(found.time, joint.states(found.q, found.v), found.seconds)
