"""Rapier's step, and the scheme of the reference that it is."""

from __future__ import annotations

from omegadot.adapters.protocol import Integrator
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import System

STEP = "step"
ITERATIONS = 4  # Rapier's default of IntegrationParameters.num_solver_iterations
RESCALED = "semi-implicit-euler-rescaled-momentum-four-substeps"
FREE = (
    "PhysicsWorld.step, in num_solver_iterations = 4 substeps: w = w0 + h a, L = I w, "
    "w1 = I^-1 (L - h w x L) |L| / |L - h w x L|, q1 = q + h/2 (0, w1) q, made unit; "
    "a = I^-1 t stays in world axes"
)
PIVOTED = (
    "PhysicsWorld.step, in num_solver_iterations = 4 substeps: w1 = w + h (1 - h J)^-1 w', J the "
    "derivative of w' by w, or 0 where J adds energy, and the rotation of h w1"
)


def declared_integrators(system: System | None) -> tuple[Integrator, ...]:
    """The step, as it steps this system.

    A pivoted body has steps of linearly implicit Euler, but for those in which J adds energy.
    """
    pivoted = system is not None and system.load.pivot is not None
    orders = dict(SCHEMES[RESCALED].orders)
    scheme, note = (None, PIVOTED) if pivoted else (RESCALED, FREE)
    return (Integrator(STEP, scheme, orders, note=note),)
