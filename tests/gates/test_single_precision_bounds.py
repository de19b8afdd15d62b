"""Bounds in single precision: those of double, by formula, and no bound of double has changed.

What these tests catch: a gate that holds a single-precision engine to doubles, or the other way
round; steps to the limit so short that rounding hides all; a step where rounding outweighs
truncation that is reported where the error shrinks, or that hides a fault.
"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from omegadot.gates.bounds.measures import Yardstick
from omegadot.gates.bounds.scales import EPS, eps_of
from omegadot.gates.case import Sweep
from omegadot.gates.errors.findings import Declared
from omegadot.gates.errors.measured_run import CHANNELS, MeasuredRun
from omegadot.gates.errors.rounding_step import rows as rounding_rows
from omegadot.gates.rows import Row
from omegadot.gates.runs import phase, trajectory
from omegadot.gates.runs.exact import floors
from omegadot.gates.states import equation, model
from omegadot.gates.steps import vanishing_step
from omegadot.gates.steps.limits import limits
from omegadot.gates.steps.probe import DOUBLE, SINGLE, Probe, ladder_of, probe_of
from omegadot.gates.truth import Truth
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.motion import forward_dynamics, inverse_dynamics
from omegadot.reference_impl.rotations import (
    normalize,
    quaternion_product,
    rotate,
    rotate_inverse,
)
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Array, Body, Load, State, System
from omegadot.written import written

SINGLES = 2.0**-23
RATIO = 2.0**29
TIMES = np.array([0.0, 0.5, 1.0, 1.5, 2.0, 2.5])
BODY = Body(np.array(2.0), np.array([0.1, 0.0, 0.5]), np.diag([1.0, 2.0, 2.5]))
SYSTEM = System((BODY,), Load(gravity=np.array([0.0, 0.0, -3.0]), pivot=np.array([0.2, 0.1, 0.0])))
SPIN = np.array([[1.0, -2.0, 0.5]]) * np.linspace(1.0, 0.5, len(TIMES))[:, None]
STATES = place_on_pivot(SYSTEM, State(np.tile([0.5, 0.5, -0.5, 0.5], (6, 1)), SPIN, SPIN, SPIN))
SWEEP = Sweep(0.5, 5, 1)


@pytest.fixture(scope="module")
def truth() -> Truth:
    growth, floor = np.linspace(1.0, 7.0, 6), {"omega": np.full(6, 1e-15), "attitude": TIMES * EPS}
    omega_dot = forward_dynamics(SYSTEM, STATES).angular
    yardstick = Yardstick(SYSTEM, TIMES, STATES)
    return Truth("series", TIMES, STATES, omega_dot, growth, floor, yardstick)


def test_the_eps_of_a_precision() -> None:
    assert (eps_of("float64"), eps_of("float32")) == (EPS, SINGLES) == (2.0**-52, EPS * RATIO)


def test_double_is_what_it_was(truth: Truth) -> None:
    assert truth.in_precision("float64") is truth
    yardstick, steps = truth.yardstick, np.array([0.0, 10.0, 40.0])
    assert yardstick.eps == EPS
    bounds = yardstick.round_off(0.1, steps, np.array([1.0, 2.0, 8.0]))
    expected = 16 * EPS * (steps + 1.0)
    expected = expected * (1.0 + 0.1 * yardstick.acceleration / yardstick.rate)
    assert np.array_equal(bounds["omega"], expected * np.array([1.0, 2.0, 8.0]))


def test_rounding_and_floors_are_in_proportion_to_eps(truth: Truth) -> None:
    single = truth.in_precision("float32")
    assert single.in_precision("float64").yardstick.eps == EPS
    assert single.companions is truth.companions
    own = {"eps": SINGLES, "per_rounding": single.yardstick.per_rounding}
    assert vars(single.yardstick) == vars(truth.yardstick) | own
    least = floors(truth)
    for channel, values in floors(single).items():
        np.testing.assert_allclose(values, RATIO * least[channel], rtol=1e-5)  # and its square


def test_rounding_of_a_run_is_in_proportion_to_eps_and_that_of_its_momentum() -> None:
    ball = System((Body(np.array(2.0), np.zeros(3), 2.0 * np.eye(3)),))
    how = (0.25, np.arange(6.0), np.linspace(1.0, 7.0, 6))
    round_ball, bar = (Yardstick(system, TIMES, STATES) for system in (ball, SYSTEM))
    double, single = (round_ball.with_eps(eps).round_off(*how) for eps in (EPS, SINGLES))
    assert set(single) == set(CHANNELS)
    for channel, bound in single.items():
        # energy and angular momentum have the square of theta besides
        np.testing.assert_allclose(
            bound, RATIO * double[channel], rtol=2.0 * float(single["omega"][-1])
        )
    inertia = moving_inertia(SYSTEM)
    products = np.linalg.norm(np.abs(SPIN) @ np.abs(inertia), axis=-1)
    spin = np.max(products) / np.linalg.eigvalsh(inertia)[0]
    found = bar.with_eps(SINGLES)
    assert found.per_rounding > 1.0
    assert found.per_rounding == pytest.approx(spin / bar.rate)
    each = found.per_rounding + 0.25 * bar.acceleration / bar.rate
    expected = 16 * SINGLES * (how[1] + 1.0) * each * how[2]
    np.testing.assert_allclose(found.round_off(*how)["attitude"], expected, rtol=8 * EPS)
    assert found.with_eps(EPS).per_rounding == 1.0


def gate_rows(eps: float) -> dict[str, list[Row]]:
    case = SimpleNamespace(system=SYSTEM)
    acceleration = forward_dynamics(SYSTEM, STATES)
    torque = inverse_dynamics(SYSTEM, STATES, acceleration)
    return {
        "body": model.body_rows(case, BODY, eps),
        "state": model.state_rows(case, STATES[0], STATES[0], eps),
        "forward": equation.forward_rows(SYSTEM, STATES, acceleration, "residual", eps),
        "inverse": equation.inverse_rows(SYSTEM, STATES, acceleration, torque, eps=eps),
        "run": trajectory.omega_dot_rows(SYSTEM, STATES, acceleration.angular, eps),
        "time": [trajectory.time_row(SWEEP, TIMES, eps)],
    }


def test_every_gates_bound_is_in_proportion_to_eps() -> None:
    double, single = gate_rows(EPS), gate_rows(SINGLES)
    for name, rows in double.items():
        assert rows
        assert [row.bound * RATIO for row in rows] == [row.bound for row in single[name]]


def test_what_a_run_reports_is_held_to_its_own_precision(truth: Truth) -> None:
    def lengths(precision: str, off: float) -> str:
        own = truth.in_precision(precision)
        bounds = own.yardstick.round_off(0.5, SWEEP.sample_steps, own.growth)
        measured = MeasuredRun(SWEEP, dict.fromkeys(CHANNELS, np.zeros(6)), bounds)
        state = State(STATES.orientation * (1.0 + off), SPIN, SPIN, SPIN)
        rows = trajectory.reported_rows(own, measured, state, precision)
        return next(row.verdict for row in rows if row.metric == "unit_length")

    assert lengths("float64", 15 * EPS) == lengths("float32", 15 * SINGLES) == "pass"
    assert lengths("float64", 15 * SINGLES) == lengths("float32", 40 * SINGLES) == "fail"


@pytest.mark.parametrize("eps", [EPS, SINGLES])
def test_a_clock_may_round_the_step_and_its_multiples(eps: float) -> None:
    assert trajectory.time_row(SWEEP, TIMES * (1.0 + eps), eps).verdict == "pass"
    assert trajectory.time_row(SWEEP, TIMES * (1.0 + 3 * eps), eps).verdict == "fail"


def test_a_shift_within_rounding_is_not_looked_for(truth: Truth) -> None:
    single = truth.in_precision("float32")
    none = dict.fromkeys(CHANNELS, np.full(6, np.inf))
    measured = MeasuredRun(SWEEP, dict.fromkeys(CHANNELS, np.zeros(6)), none)
    for own, eps in ((truth, EPS), (single, SINGLES)):
        shift = phase.rows(own, measured, STATES)[0]
        assert shift.metric == "time_shift"
        assert shift.bound is not None
        assert shift.bound > eps * own.yardstick.rate / np.max(np.abs(own.omega_dot)) / 2


def probed(eps: float) -> Probe:
    states = SimpleNamespace(random=STATES, path=STATES)
    return probe_of(SYSTEM, states, eps)  # type: ignore[arg-type]


def test_steps_to_the_limit_are_longer_where_rounding_is_coarser() -> None:
    assert (ladder_of(EPS), ladder_of(SINGLES)) == (DOUBLE, SINGLE)
    double, single = probed(EPS), probed(SINGLES)
    assert (double.timesteps.shape[1], single.timesteps.shape[1]) == (9, 5)
    ratio = SINGLE.radians / DOUBLE.radians
    np.testing.assert_allclose(single.timesteps[:, 0], ratio * double.timesteps[:, 0], rtol=1e-12)


@pytest.mark.parametrize(("eps", "part", "fault"), [(EPS, 1e-9, 1e-8), (SINGLES, 1e-2, 1e-2)])
def test_what_the_limit_leaves_open_is_little(eps: float, part: float, fault: float) -> None:
    """Steps without any error of their own: what is left of the bound is rounding."""
    probe = probed(eps)
    h = probe.timesteps[..., None]
    states, true = probe.states, forward_dynamics(SYSTEM, probe.states)

    def stepped(rate: Array) -> State:
        before = states[:, None]
        spin = before.angular_velocity + h * rate[:, None]
        still = [
            before.orientation + 0 * h,
            before.position + 0 * h,
            before.linear_velocity + 0 * h,
        ]
        return State(still[0], spin, still[1], still[2])

    found = limits(SYSTEM, probe, stepped(true.angular), eps)["omega"]
    assert np.max(found.shares()) <= 1.0
    assert np.all(np.min(found.bound, axis=0) < part * np.linalg.norm(true.angular, axis=-1))
    wrong = limits(SYSTEM, probe, stepped((1 + fault) * true.angular), eps)["omega"]
    assert np.min(wrong.shares()) > 1.0


def test_no_limit_is_sought_where_the_inverse_of_the_inertia_has_no_digit() -> None:
    def verdicts(least: float, eps: float) -> set[str]:
        body = Body(np.array(1.0), np.zeros(3), np.diag([1.0, 1.0, least]))
        system = System((body,))
        states = SimpleNamespace(random=STATES, path=STATES)
        probe = probe_of(system, states, eps)  # type: ignore[arg-type]
        stays = State(
            *(v[:, None] + 0 * probe.timesteps[..., None] for v in vars(probe.states).values())
        )
        return {row.verdict for row in vanishing_step.rows(system, probe, stays, eps)}

    assert "fail" in verdicts(65 * SINGLES, SINGLES)
    assert verdicts(63 * SINGLES, SINGLES) == {"info"}
    assert "fail" in verdicts(63 * SINGLES, EPS)


def momentum_stepped(system: System, probe: Probe) -> State:
    """A Runge-Kutta step of the free body's attitude alone: its momentum stays as it is."""
    q = np.broadcast_to(probe.states.orientation[:, None], (*probe.timesteps.shape, 4))
    tensor, h = moving_inertia(system), probe.timesteps[..., None]
    momentum = rotate(q, apply(tensor, probe.states.angular_velocity[:, None]))

    def omega(q: Array) -> Array:
        return apply(inverse(tensor), rotate_inverse(normalize(q), momentum))

    def rate(q: Array) -> Array:
        w = omega(q)
        return 0.5 * quaternion_product(q, np.concatenate((0 * w[..., :1], w), axis=-1))

    k1 = rate(q)
    k2 = rate(q + h / 2 * k1)
    k3 = rate(q + h / 2 * k2)
    k4 = rate(q + h * k3)
    q = normalize(q + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4))
    place = probe.states.position[:, None] + h * probe.states.linear_velocity[:, None]
    return State(q, omega(q), place, probe.states.linear_velocity[:, None] + 0 * h)


@pytest.mark.parametrize("thin", [0.3, 1e-2, 1e-3, 4e-4])
def test_a_momentum_in_world_axes_needs_short_steps_of_a_thin_body(thin: float) -> None:
    """An error of the attitude changes omega by J / lambda times as much."""
    system = System((Body(np.array(1.0), np.zeros(3), np.diag([1.0, 1.0, thin])),))
    states = SimpleNamespace(random=STATES, path=STATES)
    for eps in (EPS, SINGLES):
        probe = probe_of(system, states, eps)  # type: ignore[arg-type]
        rows = vanishing_step.rows(system, probe, momentum_stepped(system, probe), eps)
        judged = {row.channel: row.verdict for row in rows}
        assert "fail" not in judged.values()
        assert (judged["omega"] == "info") is (eps == SINGLES and thin <= 1e-2)
        assert judged["position"] == "pass"


def sweep_of_errors(*errors: float, bound: float = 1e-3) -> list[MeasuredRun]:
    """At steps of 0.1 s and halves of it; rounding's bound is that at the coarsest, and doubles."""
    found = []
    for n, error in enumerate(errors):
        sweep = Sweep(0.1 / 2**n, 2, 1)
        own = dict.fromkeys(CHANNELS, np.array([0.0, 0.5, 1.0]) * error)
        found.append(MeasuredRun(sweep, own, dict.fromkeys(CHANNELS, np.full(3, bound * 2**n))))
    return found


def rounding(runs: list[MeasuredRun], order: int | None = 2, eps: float = SINGLES) -> list[Row]:
    return rounding_rows(runs, Declared(None, dict.fromkeys(CHANNELS, order)), eps)


@pytest.mark.parametrize("order", [1, 2, 4])
@pytest.mark.parametrize("meet", [0.002, 0.005, 0.02])
def test_the_step_where_rounding_meets_truncation(order: int, meet: float) -> None:
    steps = 0.1 / 2.0 ** np.arange(9)
    amount = 1e-2 * (meet / 0.1) ** order
    errors = np.maximum(amount * (steps / meet) ** order, amount * meet / steps)
    rows = rounding(sweep_of_errors(*errors), order)
    assert [row.channel for row in rows] == ["omega", "attitude"]
    for row in rows:
        assert row.value == pytest.approx(meet, rel=1e-9)
        assert row.bound is not None
        assert row.bound > row.value
        assert row.verdict == "info"
        assert f"rounding outweighs truncation below h = {written(meet, 2)} s" in row.note


def test_errors_that_grow_from_the_coarsest_step_on_are_rounding_at_every_step() -> None:
    (row, _) = rounding(sweep_of_errors(1e-5, 3e-5, 5e-5))
    assert (row.value, row.bound) == (0.1, None)
    assert row.note.endswith("at every step here")


def test_no_such_step_where_errors_shrink_or_rounding_cannot_account_for_them() -> None:
    assert rounding(sweep_of_errors(1e-1, 3e-2, 1e-2)) == []
    assert rounding(sweep_of_errors(1e-1, 3e-2, 5e-2)) == []  # beyond the bound: a fault
    assert rounding(sweep_of_errors(1e-1, 1e-5, 2e-5), order=None) == []  # conserved
    assert rounding(sweep_of_errors(1e-1, 1e-5, 2e-5), eps=EPS) == []
    assert rounding([]) == []
    assert rounding(sweep_of_errors(1e-1, 1e-5, 2e-5))[0].value < 0.1
