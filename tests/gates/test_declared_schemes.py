"""A declared scheme is a claim on every step: of two schemes of an order none passes as the other.

On mild motions two schemes of an order differ by little, and by terms that vanish faster than the
error of either. Caught: a gate that takes such terms for the same scheme, less finely computed.
"""

from __future__ import annotations

from dataclasses import replace

import pytest
from in_process import builtin, judged, truth_of

from omegadot.adapters.protocol import Integrator, Trajectory
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.diagnosis.stepping.explicit_schemes import EXPLICIT
from omegadot.diagnosis.stepping.step_ends import second_order_turn, with_end
from omegadot.gates.case import Case, Sweep
from omegadot.gates.rows import Row
from omegadot.reference_impl.schemes import SCHEMES, Motion, Scheme
from omegadot.reference_impl.schemes.scheme import every_channel
from omegadot.reference_impl.schemes.semi_implicit_euler import step as euler_step
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, State

# Damped, so that the motion itself is soon slow; by steps that turn the body by little.
MILD = builtin("damped-tumble", 0.02, 0.01, 0.005)
# Without damping, where the last terms of two schemes of order 4 are clear of rounding.
WILD = builtin("full-tensor", 0.04, 0.02, 0.01)
# Turns below a thousandth of a radian, which the short turns expand to second order.
FINE = replace(MILD, sweeps=(Sweep(1e-4, 400, 80), Sweep(5e-5, 800, 160), Sweep(2.5e-5, 1600, 320)))


class Stepped(ReferenceAdapter):
    """The reference, stepping a scheme of one's choice whatever is declared."""

    def __init__(self, scheme: Scheme) -> None:
        super().__init__()
        self.scheme = scheme

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        how = (self.scheme, self.system, initial)
        return Trajectory(*step_body(*how, timestep, steps, every))


def _straight(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    """Semi-implicit Euler whose quaternion is stepped as q + h/2 q omega and made unit."""
    _, v = euler_step(motion, q, v, h)
    return motion.normalize(q + h * motion.coordinate_rate(q, v)), v


def _unsolved(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    """The implicit midpoint whose equation is solved by four substitutions, not to the end."""
    w = v
    for _ in range(4):
        halfway = motion.retract(q, 0.5 * motion.cayley(h * w))
        w = v + 0.5 * h * motion.acceleration(halfway, w)
    return motion.retract(q, motion.cayley(h * w)), 2 * w - v


STRAIGHT = Scheme("straight", "", _straight, every_channel(1))
SHORT_SERIES = replace(
    with_end(SCHEMES["semi-implicit-euler"], second_order_turn), name="second-order exponential"
)
UNSOLVED = Scheme("unsolved", "", _unsolved, every_channel(2))
PAIRS = [
    (MILD, "semi-implicit-euler", STRAIGHT),
    (MILD, "semi-implicit-euler", SHORT_SERIES),
    (MILD, "rk4-quaternion", SCHEMES["lie-rk4"]),
    (MILD, "lie-rk4", SCHEMES["rk4-quaternion"]),
    (WILD, "lie-rk4", SCHEMES["munthe-kaas-rk4"]),
    (WILD, "munthe-kaas-rk4", SCHEMES["lie-rk4"]),
    (MILD, "rk4-quaternion", EXPLICIT["Kutta's 3/8 method on the quaternion"]),
    (MILD, "implicit-midpoint", EXPLICIT["Heun's method on the quaternion"]),
    (MILD, "implicit-midpoint", EXPLICIT["the explicit midpoint method with the exponential"]),
    (WILD, "implicit-midpoint", UNSOLVED),
    (FINE, "semi-implicit-euler", SCHEMES["semi-implicit-euler-short-turns"]),
    (FINE, "semi-implicit-euler-short-turns", SCHEMES["semi-implicit-euler"]),
]


def matches(case: Case, name: str, scheme: Scheme) -> list[Row]:
    integrator = Integrator(name, name, dict(SCHEMES[name].orders))
    runs = judged(case, truth_of(case, (name,)), integrator, Stepped(scheme))
    return [row for run in runs for row in run.rows if row.metric == "match"]


@pytest.mark.parametrize(
    ("case", "name", "scheme"), PAIRS, ids=[f"{name}, {scheme.name}" for _, name, scheme in PAIRS]
)
def test_another_scheme_of_the_order_fails_at_every_step(
    case: Case, name: str, scheme: Scheme
) -> None:
    found = matches(case, name, scheme)
    assert [row.verdict for row in found] == ["fail"] * 3
    assert all(row.note.startswith(f"declares {name}, but steps otherwise") for row in found)


@pytest.mark.parametrize("case", [MILD, WILD], ids=["mild", "wild"])
@pytest.mark.parametrize("name", SCHEMES)
def test_the_scheme_itself_passes_at_every_step(case: Case, name: str) -> None:
    assert [row.verdict for row in matches(case, name, SCHEMES[name])] == ["pass"] * 3
