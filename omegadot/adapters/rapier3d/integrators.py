"""Rapier's step, by the solver iterations that divide it, and the schemes that it is."""

from __future__ import annotations

from omegadot.adapters.protocol import Integrator
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import System

ITERATIONS = {"step": 4, "one-iteration": 1}
"""Of each integrator: `IntegrationParameters.num_solver_iterations`. Rapier's default is 4."""
RESCALED = "semi-implicit-euler-rescaled-momentum-four-substeps"
IMPLICIT = "linearly-implicit-euler"
FREE = (
    "w = w0 + h/n a, L = I w, w1 = I^-1 (L - h/n w x L) |L| / |L - h/n w x L|, "
    "q1 = q + h/2n (0, w1) q, made unit; a = I^-1 t stays in world axes"
)
PIVOTED = "w1 = w + h/n (1 - h/n J)^-1 w', J the derivative of w' by w, and the rotation of h/n w1"


def declared_integrators(system: System | None, damped: bool) -> tuple[Integrator, ...]:
    """Both, as they step this system.

    damped: by Rapier's own default, which is no damping of the system.
    A free body is turned straight in the quaternion, which no scheme of the reference is with one
    substep. Of a pivoted body the steps of linearly implicit Euler are as many as the iterations.
    """
    pivoted = system is not None and system.load.pivot is not None
    schemes = {"step": None, "one-iteration": None if damped else IMPLICIT}
    if not pivoted:
        schemes = {"step": RESCALED, "one-iteration": None}
    orders = dict(SCHEMES[IMPLICIT if pivoted else RESCALED].orders)
    return tuple(
        Integrator(name, schemes[name], dict(orders), note=_note(count, pivoted))
        for name, count in ITERATIONS.items()
    )


def _note(count: int, pivoted: bool) -> str:
    return f"PhysicsWorld.step with num_solver_iterations = n = {count}, in as many substeps: " + (
        PIVOTED if pivoted else FREE
    )
