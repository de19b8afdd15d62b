"""PyBullet's two ways to keep a body, each with the integrator that goes with it."""

from __future__ import annotations

from typing import Literal

from omegadot.adapters.protocol import Integrator
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import Load, System

Kind = Literal["multibody", "maximal"]
KINDS: tuple[Kind, ...] = ("multibody", "maximal")
EULER, IMPLICIT = "semi-implicit-euler", "linearly-implicit-euler"
NOTES: dict[Kind, str] = {
    "multibody": "btMultiBody: v1 = v + h v', and the rotation of h w1",
    "maximal": "btRigidBody: w1 = w - (1 - h J)^-1 h I^-1 (w x I w) + h I^-1 t, J the derivative "
    "of -I^-1 (w x I w) by w, and the rotation of h w1",
}


def is_driven(load: Load) -> bool:
    """Whether a torque is applied, in body or in world axes."""
    return bool(load.torque_body.any() or load.torque_world.any())


def declared_integrators(system: System | None) -> tuple[Integrator, ...]:
    """Both, as they step this system.

    The scheme of the reference solves for a torque as well, which is the same where it is zero.
    """
    driven = system is not None and is_driven(system.load)
    schemes = {"multibody": EULER, "maximal": None if driven else IMPLICIT}
    orders = {"multibody": EULER, "maximal": IMPLICIT}
    return tuple(
        Integrator(kind, schemes[kind], dict(SCHEMES[orders[kind]].orders), note=NOTES[kind])
        for kind in KINDS
    )
