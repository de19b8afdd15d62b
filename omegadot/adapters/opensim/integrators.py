"""OpenSim's integrators, those of Simbody that its `Manager` has, and how each is set up."""

from __future__ import annotations

from dataclasses import dataclass

from omegadot.adapters.protocol import Integrator, Knob

CHANNELS = ("omega", "attitude", "energy", "angular_momentum", "linear_momentum", "position")
FIXED = "-fixed"
# Of Verlet's rounds, in parts of u, in the setup "physics". It is the finest that they keep to.
SOLVES = 1e-12
# All step y = (q, u) as one vector, q three angles and a place, u omega and a velocity in the axes
# of the joint's frame: what follows the method in the name of the reference's scheme.
CHART = "two-frames-xyz"
HALVES = "semi-implicit Euler, u1 = u + h a, q1 = q + h N u1, twice with half the step"
VERLET = (
    "q1 = q + h q' + h^2/2 q'', u1 = u + h/2 (a + a(q1, u1)) in rounds of fixed-point iteration"
)
BDF = "CPODES: backward differences of orders 1 to 5, which keep earlier steps"


@dataclass(frozen=True)
class Plan:
    """How an integrator is set up.

    method: its name in OpenSim.  order: of its errors.  fixed: whether its steps are those
    requested.  solves: the accuracy to which a fixed step solves its equation, 0 where it has none.
    finest_accuracy: the smallest that is requested where steps are not fixed, 0 where any may be.
    one_step: whether a step depends on the state alone.  reference: the reference's method that it
    steps, "" where this has none.
    """

    method: str
    order: int
    note: str
    fixed: bool = False
    solves: float = 0.0
    finest_accuracy: float = 0.0
    one_step: bool = True
    reference: str = ""

    @property
    def knob(self) -> Knob:
        """What of it can be set."""
        if not self.fixed:
            return "accuracy"
        return "fixed-accuracy" if self.solves else "timestep"


# Name, order, the reference's method, note, finest accuracy. The latter is a matter of cost: where
# an error is estimated at order 1 a hundredth of the accuracy takes ten times the steps.
METHODS = (
    ("RungeKuttaMerson", 4, "merson4", "Merson's method, the solution of order 4", 0.0),
    ("RungeKuttaFeldberg", 4, "fehlberg4", "Fehlberg's 4(5), the solution of order 4", 0.0),
    ("RungeKutta3", 3, "kutta3", "Kutta's method of order 3", 1e-9),
    ("RungeKutta2", 2, "heun", "Heun's method, the explicit trapezoidal rule", 1e-3),
    ("Verlet", 2, "", VERLET, 1e-7),
    ("SemiExplicitEuler2", 1, "semi-implicit-euler-in-two", HALVES, 1e-3),
    ("ExplicitEuler", 1, "explicit-euler", "y + h f(y)", 1e-3),
)


def _plans() -> dict[str, Plan]:
    found = {}
    for name, order, method, note, finest in METHODS:
        found[name] = Plan(name, order, note, finest_accuracy=finest)
        solves = SOLVES if name == "Verlet" else 0.0
        found[name + FIXED] = Plan(name, order, note, fixed=True, solves=solves, reference=method)
    return found | {"CPodes": Plan("CPodes", 1, BDF, one_step=False)}


PLANS = _plans()


def plan_of(name: str) -> Plan | None:
    """The set-up of an integrator; None where there is none of this name."""
    return PLANS.get(name)


def declared_integrators(two_frames: bool = True) -> tuple[Integrator, ...]:
    """Every integrator. two_frames: whether the joint's frame is one of two.

    The reference steps angles in two frames alone: of one, errors know no bound.
    """
    return tuple(
        Integrator(
            name,
            f"{plan.reference}-{CHART}" if plan.reference and two_frames else None,
            dict.fromkeys(CHANNELS, plan.order),
            knob=plan.knob,
            note=plan.note,
            coordinates="origin-world",
            one_step=plan.one_step,
            finest_accuracy=plan.solves or plan.finest_accuracy,
        )
        for name, plan in PLANS.items()
    )
