"""iDynTree behind the protocol: its dynamics, and the reference's schemes stepping them.

iDynTree computes dynamics and has no stepper, so every integrator here is named
``dynamics+<scheme of the reference>``.
"""

from __future__ import annotations

from importlib.metadata import version
from typing import Literal

from omegadot.adapters.idyntree.joint import IDynTreeJoint
from omegadot.adapters.idyntree.model import build_model, read_model
from omegadot.adapters.looped import LoopedAdapter, looped_integrators
from omegadot.adapters.protocol import ONE_BODY, Description, Format, Setup
from omegadot.reference_impl.system import System

PREFIX = "dynamics+"
NOTE = "the reference's scheme over iDynTree's forward dynamics, not a stepper of iDynTree's own"

CONVENTIONS = (
    "quaternions are (w, x, y, z); spatial vectors are (linear, angular)",
    "velocities are in the representation that is set, here BODY_FIXED: of the body's origin, in "
    "body axes; a new KinDynComputations has MIXED, which is in world axes",
    "every model floats: a free body is its base, a pivoted one is on a spherical joint, whose "
    "velocity is omega in body axes, to a link that stands still",
    "no stepper: the reference's schemes step iDynTree's accelerations in these coordinates",
    "a free body's acceleration is by ArticulatedBodyAlgorithm, which takes no gravity: g is added "
    "to what it gives",
    "ArticulatedBodyAlgorithm refuses joints of several degrees of freedom: a pivoted body's "
    "omega-dot is solved of its mass matrix and bias forces",
    "a link's inertia is kept about its frame's origin, that about the centre of mass is taken "
    "from it",
    "no damping in the dynamics: -damping * omega and the applied torques are an external wrench "
    "of a free body, and a torque of the joint of a pivoted one",
)
SWITCHED_OFF = (
    "rounding by the unit of length, as ArticulatedBodyAlgorithm solves six equations of two units "
    "by QR without scaling them: it is given lengths in the body's radius of gyration about the "
    "link's frame, to a power of two",
)
LINKS = (
    "https://github.com/robotology/idyntree",
    "https://robotology.github.io/idyntree/master/",
)


class IDynTreeAdapter(LoopedAdapter):
    """iDynTree 15.1 and later. Raises ImportError when it is not installed."""

    name, prefix = "idyntree", PREFIX

    def __init__(self, setup: Setup = "physics") -> None:
        from idyntree import bindings

        self._engine, self._setup = bindings, setup

    @property
    def description(self) -> Description:
        """The engine as it is installed."""
        return Description(
            name=self.name,
            version=version("idyntree"),
            integrators=looped_integrators(PREFIX, NOTE),
            conventions=CONVENTIONS,
            switched_off=SWITCHED_OFF if self._setup == "physics" else (),
            features=ONE_BODY,
            licence="BSD-3-Clause",
            links=LINKS,
            importers=("urdf",),
        )

    def _built(self, system: System, via: Format | Literal[""]) -> IDynTreeJoint:
        model = read_model(self._engine, system) if via else build_model(self._engine, system)
        return IDynTreeJoint(self._engine, system, model, self._setup)
