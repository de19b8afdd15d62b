"""Drake's integrators, and how each is set up."""

from __future__ import annotations

from dataclasses import dataclass

from omegadot.adapters.drake.model import Stepping
from omegadot.adapters.protocol import Integrator

CHANNELS = ("omega", "attitude", "energy", "angular_momentum", "linear_momentum", "position")
FIXED = "-fixed"


@dataclass(frozen=True)
class Plan:
    """How an integrator is set up.

    scheme: its name in Drake, "" for a discrete plant, whose contact approximation is then named.
    order: of its errors.  fixed: whether its steps are those requested.  solves: the accuracy to
    which a fixed step solves its equation, 0 where it has none to solve.
    """

    scheme: str
    order: int
    approximation: str = ""
    fixed: bool = True
    solves: float = 0.0
    finest_accuracy: float = 0.0
    note: str = ""

    def stepping(self, timestep: float) -> Stepping:
        """What the diagram is built for."""
        if not self.scheme:
            return Stepping(timestep=timestep, approximation=self.approximation)
        return Stepping(period=timestep)


def _plans() -> dict[str, Plan]:
    found = {
        "discrete": Plan("", 1, "kLagged"),
        "discrete-tamsi": Plan("", 1, "kTamsi"),
        "explicit_euler": Plan("explicit_euler", 1),
        "semi_explicit_euler": Plan("semi_explicit_euler", 1),
        "runge_kutta2": Plan("runge_kutta2", 2),
    }
    for name, order in {"bogacki_shampine3": 3, "runge_kutta3": 3, "runge_kutta5": 5}.items():
        found[name] = Plan(name, order, fixed=False)
        found[name + FIXED] = Plan(name, order)
    implicit = {"implicit_euler": 1, "velocity_implicit_euler": 1, "radau1": 1, "radau3": 3}
    for name, order in implicit.items():
        finest = 1e-5 if order == 1 else 1e-9
        found[name] = Plan(name, order, fixed=False, finest_accuracy=finest)
        solves = 1e-8 if name == "velocity_implicit_euler" else 1e-12
        found[name + FIXED] = Plan(name, order, solves=solves)
    return found


PLANS = _plans()


def plan_of(name: str) -> Plan | None:
    """The set-up of an integrator; None where there is none of this name."""
    return PLANS.get(name)


def declared_integrators(*, pivoted: bool) -> tuple[Integrator, ...]:
    """Every integrator, with what it does to a free body or to a pivoted one."""
    return tuple(
        Integrator(
            name,
            None,
            dict.fromkeys(CHANNELS, plan.order),
            knob="fixed-accuracy" if plan.solves else "timestep" if plan.fixed else "accuracy",
            note=plan.note,
            finest_accuracy=plan.solves or plan.finest_accuracy,
        )
        for name, plan in PLANS.items()
    )
