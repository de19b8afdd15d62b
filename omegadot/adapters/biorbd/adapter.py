"""biorbd behind the protocol: RBDL's dynamics, and the reference's schemes stepping them.

biorbd computes dynamics and has no stepper, so every integrator here is named
``dynamics+<scheme of the reference>``.
"""

from __future__ import annotations

from importlib import import_module
from importlib.metadata import version
from typing import Any, Literal

from omegadot.adapters.biorbd.joint import BiorbdJoint
from omegadot.adapters.looped import LoopedAdapter, looped_integrators
from omegadot.adapters.protocol import ONE_BODY, Description, Format, Setup
from omegadot.reference_impl.system import System

PREFIX = "dynamics+"
NOTE = "the reference's scheme over biorbd's ForwardDynamics, not a stepper of biorbd's own"

CONVENTIONS = (
    "a free body is a segment of three translations and a quaternion, a pivoted one of a "
    "quaternion at the pivot",
    "quaternions are (x, y, z, w) in Q; the velocity is that of the body's origin in world axes, "
    "then omega in body axes",
    "ForwardDynamics answers with as many numbers as Q has: the last is none of an acceleration",
    "segmentAngularVelocity is in world axes",
    "damping is the joint's own (jointDampings); InverseDynamics subtracts it where it has to be "
    "added, so that it is requested of a model without damping",
    "no stepper: the reference's schemes step ForwardDynamics, in the spatial velocity of the "
    "body's origin in body axes",
)
LINKS = (
    "https://github.com/pyomeca/biorbd",
    "https://github.com/rbdl/rbdl",
)


class BiorbdAdapter(LoopedAdapter):
    """biorbd 1.12. Nothing in it spoils physics, so both setups are the same."""

    name, prefix = "biorbd", PREFIX

    def __init__(self, setup: Setup = "physics") -> None:
        self._engine: Any = import_module("biorbd")

    @property
    def description(self) -> Description:
        """The engine as it is installed."""
        return Description(
            name=self.name,
            version=version("biorbd"),
            integrators=looped_integrators(PREFIX, NOTE),
            conventions=CONVENTIONS,
            features=ONE_BODY,
            licence="MIT",
            links=LINKS,
        )

    def _built(self, system: System, via: Format | Literal[""]) -> BiorbdJoint:
        return BiorbdJoint(self._engine, system)
