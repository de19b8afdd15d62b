"""Steps that fall back to another scheme by what they start from."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from wrong_equations import BODY_TORQUE, GRAVITY, PIVOT, case

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.explicit_schemes import scheme_named
from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.stepping.slips.scheme_by_state import scheme_by_state
from omegadot.gates.case import Case, Sweep
from omegadot.reference_impl.schemes import SCHEMES, Motion
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array

RK4, HEUN = SCHEMES["rk4-quaternion"], "Heun's method on the quaternion"
ORDERS = dict.fromkeys(("omega", "attitude"), 4)
CASES = (
    case("damped", {"damping": 2.0, "torque": BODY_TORQUE}),
    case("held", {"pivot": PIVOT, "gravity": GRAVITY}),
    case("driven", {"torque": {"frame": "world", "value": [-2.7, 1.2, 2.5]}}),
)


def kept(one: Case, h: float, every: int, low: Callable[[float, Array], bool]) -> KeptRun:
    """A run of RK4 in which a step is Heun's where that holds of its length and velocity."""

    def step(motion: Motion, q: Array, v: Array, dt: float | Array) -> tuple[Array, Array]:
        scheme = scheme_named(HEUN) if low(h, v[..., -3:]) else RK4
        return scheme.step(motion, q, v, dt)

    steps = round(1.6 / h)
    scheme = SCHEMES["rk4-quaternion"].__class__(RK4.name, RK4.title, step, RK4.orders)
    state = step_body(scheme, one.system, one.initial, h, steps, every)[1]
    sweep = Sweep(h, steps, every)
    sizes = dict.fromkeys(("omega", "attitude", "velocity", "position"), 1e-12)
    bounds = {c: np.full(len(sweep.times) - 1, size) for c, size in sizes.items()}
    return KeptRun(one.name, one.system, sweep, sweep.times, state, bounds, True)


def named(low: Callable[[float, Array], bool], own: str = "rk4-quaternion") -> list[str]:
    by = SchemeOf(scheme_named(own), "com-world")
    runs = [kept(one, h, n, low) for one in CASES for h in (0.04, 0.02, 0.01) for n in (1, 4)]
    return scheme_by_state(Integrator("rk4", None, ORDERS), by, runs)


@pytest.mark.parametrize("own", ["rk4-quaternion", HEUN])
def test_a_scheme_of_steps_that_turn_too_far_is_named(own: str) -> None:
    """Caught: the lower scheme taken for the right one, where it is that of most steps."""
    (text,) = named(lambda h, w: float(np.linalg.norm(w)) * h > 0.05, own)
    assert text.startswith("where the turn of a step is above a limit between 0.0")
    assert text.endswith(f"a step is by {HEUN}, not by rk4-quaternion")


def test_a_limit_of_the_velocity_is_none_of_the_turn() -> None:
    (text,) = named(lambda h, w: float(np.linalg.norm(w)) < 2.2)
    assert text.startswith("where |omega| is below a limit between 2.")


def test_what_goes_by_no_number_of_the_state_is_not_named() -> None:
    """Caught: a number that sorts most steps, or that sorts them by chance."""
    rng = np.random.default_rng(5)
    assert named(lambda h, w: rng.random() < 0.3) == []


def test_runs_of_one_scheme_show_nothing() -> None:
    assert named(lambda h, w: False) == []
