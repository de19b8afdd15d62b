"""Pinocchio behind the protocol: its ABA and RNEA, and the reference's schemes stepping its ABA.

Pinocchio computes dynamics and has no stepper, so every integrator here is named
``aba+<scheme of the reference>``. `pinocchio_joint` holds the model and the joint coordinates.
"""

from __future__ import annotations

from typing import Literal

from omegadot.adapters.looped import LoopedAdapter, looped_integrators
from omegadot.adapters.pinocchio.joint import PinocchioJoint
from omegadot.adapters.pinocchio.model import build_model, importers, read_model
from omegadot.adapters.protocol import (
    ONE_BODY,
    Description,
    Format,
    Setup,
)
from omegadot.reference_impl.system import System

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


class PinocchioAdapter(LoopedAdapter):
    """Pinocchio 3.4 and later. Nothing in it spoils physics, so both setups are the same."""

    name, prefix = "pinocchio", PREFIX

    def __init__(self, setup: Setup = "physics") -> None:
        import pinocchio

        self._engine = pinocchio

    @property
    def description(self) -> Description:
        """Pinocchio as it is installed."""
        return Description(
            name=self.name,
            version=str(self._engine.__version__),
            integrators=looped_integrators(PREFIX, NOTE),
            conventions=CONVENTIONS,
            features=ONE_BODY,
            licence="BSD-2-Clause",
            links=LINKS,
            importers=importers(self._engine),
        )

    def _built(self, system: System, via: Format | Literal[""]) -> PinocchioJoint:
        model = read_model(self._engine, system, via) if via else build_model(self._engine, system)
        return PinocchioJoint(self._engine, system, model)
