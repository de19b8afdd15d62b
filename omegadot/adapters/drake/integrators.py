"""Drake's integrators, and how each is set up."""

from __future__ import annotations

from dataclasses import dataclass

from omegadot.adapters.drake.model import Stepping
from omegadot.adapters.protocol import Integrator

CHANNELS = ("omega", "attitude", "energy", "angular_momentum", "linear_momentum", "position")
FIXED, EULER = "-fixed", "semi-implicit-euler"
# All step y = (q, v) as one vector, v with omega in world axes, q a quaternion that is not made
# unit again, or roll, pitch and yaw: what follows the method in the name of the reference's scheme.
CHARTS = {"free": "world-quaternion", "pivoted": "roll-pitch-yaw"}
SAP = (
    "MultibodyPlant(time_step): v1 = v + h (M + h D)^-1 F, q1 = q + h N v1; the contact "
    "approximations lagged, similar and sap are the same without contact"
)
TAMSI = "the same with the approximation tamsi, which takes damping at the step's start"
SOLVED = "where Newton's iterations do not converge, a fixed step is halved nevertheless"
EMBEDDED = {
    "bogacki_shampine3": (3, "bogacki-shampine3", "Bogacki and Shampine's 3(2)"),
    "runge_kutta3": (3, "kutta3", "Kutta's method of order 3"),
    "runge_kutta5": (5, "dormand-prince5", "Dormand and Prince's 5(4)"),
}
# Order, note, and the accuracy to which a fixed step solves its equation.
IMPLICIT = {
    "implicit_euler": (1, "implicit Euler, of two half steps", 1e-12),
    "velocity_implicit_euler": (1, "implicit Euler, of two half steps, iterated in v", 1e-8),
    "radau1": (1, "Radau IIA with one stage: implicit Euler", 1e-12),
    "radau3": (3, "Radau IIA with two stages", 1e-12),
}
# Finest accuracy t by order: a matter of cost, held by `tests/adapters/test_drake.py`. At order 1
# steps and errors follow sqrt(t) at every t: a hundredth of t takes ten times the steps for a
# tenth of the error, and none that can be run leads to rounding. radau3 takes 4.6 times the steps.
# Its errors keep t and follow no power of it at any t, as Newton's iterations end at 0.05 t.
FINEST = {1: 1e-3, 3: 1e-7}


@dataclass(frozen=True)
class Plan:
    """How an integrator is set up.

    scheme: its name in Drake, "" for a discrete plant, whose contact approximation is then named.
    order: of its errors.  fixed: whether its steps are those requested.  solves: the accuracy to
    which a fixed step solves its equation, 0 where it has none to solve.  finest_accuracy: the
    smallest that is requested where steps are not fixed, 0 where any may be.  method: the
    reference's that it steps, "" where this has none.
    """

    scheme: str
    order: int
    approximation: str = ""
    fixed: bool = True
    solves: float = 0.0
    finest_accuracy: float = 0.0
    note: str = ""
    method: str = ""

    def stepping(self, timestep: float) -> Stepping:
        """What the plant is built for."""
        return Stepping() if self.scheme else Stepping(timestep, self.approximation)


def _plans() -> dict[str, Plan]:
    found = {
        "discrete": Plan("", 1, "kLagged", note=SAP, method="implicit-damping-euler"),
        "discrete-tamsi": Plan("", 1, "kTamsi", note=TAMSI, method=EULER),
        "explicit_euler": Plan("explicit_euler", 1, note="y + h f(y)", method="explicit-euler"),
        "semi_explicit_euler": Plan(
            "semi_explicit_euler", 1, note="v1 = v + h a, q1 = q + h N v1", method=EULER
        ),
        "runge_kutta2": Plan(
            "runge_kutta2", 2, note="Heun's method, the explicit trapezoidal rule", method="heun"
        ),
    }
    for name, (order, method, note) in EMBEDDED.items():
        found[name] = Plan(name, order, fixed=False, note=note)
        found[name + FIXED] = Plan(name, order, note=note, method=method)
    for name, (order, note, solves) in IMPLICIT.items():
        found[name] = Plan(name, order, fixed=False, finest_accuracy=FINEST[order], note=note)
        found[name + FIXED] = Plan(name, order, solves=solves, note=f"{note}; {SOLVED}")
    return found


PLANS = _plans()


def plan_of(name: str) -> Plan | None:
    """The set-up of an integrator; None where there is none of this name."""
    return PLANS.get(name)


def declared_integrators(pivoted: bool = False) -> tuple[Integrator, ...]:
    """Every integrator, with what it steps of a free body or of a pivoted one.

    A free body's translation is that of its origin, where its joint is.
    """
    chart = CHARTS["pivoted" if pivoted else "free"]
    return tuple(
        Integrator(
            name,
            f"{plan.method}-{chart}" if plan.method else None,
            dict.fromkeys(CHANNELS, plan.order),
            knob="fixed-accuracy" if plan.solves else "timestep" if plan.fixed else "accuracy",
            note=plan.note,
            coordinates="origin-world",
            finest_accuracy=plan.solves or plan.finest_accuracy,
        )
        for name, plan in PLANS.items()
    )
