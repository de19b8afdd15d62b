"""Exudyn's integrators, and how each is set up."""

from __future__ import annotations

from dataclasses import dataclass

from omegadot.adapters.exudyn.nodes import Kind
from omegadot.adapters.protocol import Integrator, Knob

CHANNELS = ("omega", "attitude", "energy", "angular_momentum", "linear_momentum", "position")
# Residual, in parts of the first, to which a step solves its equation in the setup "physics".
SOLVES = 1e-12
# Of ODE23, for what it costs: a hundredth of the accuracy takes 4.6 times the steps.
FINEST = 1e-9
LIE = "on u' = dexp^-1(u) omega, R = R0 exp(u); on the node's place as on a vector"
VERLET = (
    "v+ = v + h a / 2, q1 = q0 exp(h v+), a1 = a(q1, v+), v1 = v+ + h a1 / 2: omega-dot is that of "
    "half a step before, so that forces that go with velocities are of order 1"
)
ALPHA = "spectral radius 0.9, as it comes; accelerations are kept from step to step"
TRAPEZOIDAL = "Newmark's method with beta = 1/4, gamma = 1/2, constraints on velocities"

# Name, solver, node, note.
IMPLICIT: tuple[tuple[str, str, Kind, str], ...] = (
    ("GeneralizedAlpha", "GeneralizedAlpha", "rotation-vector", ALPHA),
    ("GeneralizedAlpha-EP", "GeneralizedAlpha", "euler-parameters", ALPHA),
    ("TrapezoidalIndex2", "TrapezoidalIndex2", "rotation-vector", TRAPEZOIDAL),
)


@dataclass(frozen=True)
class Plan:
    """How an integrator is set up.

    solver: its name in Exudyn.  order: of its errors.  node: the kind of its node.  explicit:
    whether it has no equation to solve.  fixed: whether its steps are those requested.  scheme: the
    reference's, if it is one.  one_step: whether a step depends on the state alone.
    finest_accuracy: the smallest that is requested, or that to which a step solves its equation.
    """

    solver: str
    order: int
    note: str
    node: Kind = "rotation-vector"
    explicit: bool = True
    fixed: bool = True
    scheme: str | None = None
    one_step: bool = True
    finest_accuracy: float = 0.0

    @property
    def knob(self) -> Knob:
        """What of it can be set."""
        if not self.fixed:
            return "accuracy"
        return "timestep" if self.explicit else "fixed-accuracy"


def _plans() -> dict[str, Plan]:
    found = {
        name: Plan(solver, 2, note, node, explicit=False, one_step=False, finest_accuracy=SOLVES)
        for name, solver, node, note in IMPLICIT
    }
    return found | {
        "ExplicitEuler": Plan(
            "ExplicitEuler", 1, f"explicit Euler {LIE}", scheme="munthe-kaas-explicit-euler"
        ),
        "ExplicitMidpoint": Plan(
            *("ExplicitMidpoint", 2, f"the explicit midpoint rule {LIE}"),
            scheme="munthe-kaas-midpoint",
        ),
        "RK33": Plan("RK33", 3, f"Heun's method of order 3 {LIE}", scheme="munthe-kaas-heun3"),
        "RK44": Plan("RK44", 4, f"Kutta's method {LIE}", scheme="munthe-kaas-rk4"),
        "RK67": Plan(
            *("RK67", 6, f"Butcher's method of order 6 with seven stages {LIE}"),
            scheme="munthe-kaas-butcher6",
        ),
        "VelocityVerlet": Plan("VelocityVerlet", 1, VERLET, one_step=False),
        "ODE23": Plan(
            "ODE23", 3, f"Bogacki and Shampine's 3(2) {LIE}", fixed=False, finest_accuracy=FINEST
        ),
        "DOPRI5": Plan("DOPRI5", 5, f"Dormand and Prince's 5(4) {LIE}", fixed=False),
        "RK44-Rxyz": Plan("RK44", 4, "Kutta's method on the angles and their rates", "rxyz"),
    }


PLANS = _plans()


def plan_of(name: str) -> Plan | None:
    """The set-up of an integrator; None where there is none of this name."""
    return PLANS.get(name)


def declared_integrators() -> tuple[Integrator, ...]:
    """Every integrator. A free body's translation is that of its origin, where its node is."""
    return tuple(
        Integrator(
            name,
            plan.scheme,
            dict.fromkeys(CHANNELS, plan.order),
            knob=plan.knob,
            note=plan.note,
            coordinates="origin-world",
            one_step=plan.one_step,
            finest_accuracy=plan.finest_accuracy,
        )
        for name, plan in PLANS.items()
    )
