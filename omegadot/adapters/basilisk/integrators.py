"""Basilisk's integrators, and how each is set up."""

from __future__ import annotations

from dataclasses import dataclass

from omegadot.adapters.protocol import Integrator

CHANNELS = ("omega", "attitude", "energy", "angular_momentum", "linear_momentum", "position")
# All step y = (r, v, sigma, omega) as one vector, r and v of the body's origin in world axes, omega
# in body axes: sigma is what the reference's schemes call mrp.
STEPPED = "on (r, v, sigma, omega); the shorter sigma is taken after a step"
FEHLBERG = "the error-controlled method of Fehlberg, which goes on with the solution of order"


@dataclass(frozen=True)
class Plan:
    """How an integrator is set up.

    kind: its class in Basilisk.  order: of its errors.  fixed: whether its steps are those
    requested.  scheme: the reference's, None where this has none.
    """

    kind: str
    order: int
    note: str
    fixed: bool = True
    scheme: str | None = None


PLANS = {
    "RK4": Plan("svIntegratorRK4", 4, f"Kutta's method {STEPPED}", scheme="rk4-mrp"),
    "Euler": Plan("svIntegratorEuler", 1, f"explicit Euler {STEPPED}", scheme="explicit-euler-mrp"),
    "RK2": Plan("svIntegratorRK2", 2, f"Heun's method {STEPPED}", scheme="heun-mrp"),
    "RKF45": Plan("svIntegratorRKF45", 4, f"{FEHLBERG} 4, {STEPPED}", fixed=False),
    "RKF78": Plan("svIntegratorRKF78", 7, f"{FEHLBERG} 7, {STEPPED}", fixed=False),
}


def plan_of(name: str) -> Plan | None:
    """The set-up of an integrator; None where there is none of this name."""
    return PLANS.get(name)


def declared_integrators() -> tuple[Integrator, ...]:
    """Every integrator for motions without noise."""
    return tuple(
        Integrator(
            name,
            plan.scheme,
            dict.fromkeys(CHANNELS, plan.order),
            knob="timestep" if plan.fixed else "accuracy",
            note=plan.note,
            coordinates="origin-world",
        )
        for name, plan in PLANS.items()
    )
