"""SAPIEN's one step, and the scheme of the reference that it is."""

from __future__ import annotations

from omegadot.adapters.protocol import Integrator, Setup
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import Load, System

STEP = "step"
SCHEME = "semi-implicit-euler-rescaled-momentum"
NOTE = (
    "PxScene.simulate: w = w0 + h I^-1 t, L = I w, w1 = I^-1 (L - h w x L) |L| / |L - h w x L|, "
    "and the rotation of h w1"
)


def is_driven(load: Load) -> bool:
    """Whether a torque is applied, in body or in world axes."""
    return bool(load.torque_body.any() or load.torque_world.any())


def declared_integrators(system: System | None, setup: Setup) -> tuple[Integrator, ...]:
    """The step, as it steps this system.

    Torque pushes omega before its momentum is turned, which no scheme of the reference does. As
    shipped the body is damped.
    """
    known = setup == "physics" and not (system is not None and is_driven(system.load))
    return (Integrator(STEP, SCHEME if known else None, dict(SCHEMES[SCHEME].orders), note=NOTE),)
