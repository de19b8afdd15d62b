"""The equation gate, fed right and slightly wrong accelerations and torques."""

from types import SimpleNamespace

import numpy as np
import pytest

from omegadot.gates.bounds.scales import EPS, body_scale, linear_size, norm, torque_size
from omegadot.gates.states.equation import (
    BOUND,
    forward_rows,
    inverse_rows,
    random_acceleration,
    random_states,
    reported_rows,
)
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.motion import (
    center_of_mass_acceleration,
    forward_dynamics,
    inverse_dynamics,
)
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.system import Acceleration, Body, Load, State, System

BODY = Body(np.array(2.0), np.array([0.1, 0.0, 0.3]), np.diag([1.0, 2.0, 2.5]))
FREE = System((BODY,), Load(gravity=np.array([0.0, 1.0, -9.0])))
PIVOTED = System((BODY,), Load(gravity=np.array([0.0, 1.0, -9.0]), pivot=np.array([0.0, 0.5, 0.0])))
SEED = (3, 1, 4)


def case(system: System, w: float = 2.0, v: float = 4.0, x: float = 5.0) -> SimpleNamespace:
    q, along = np.array([1.0, 0.0, 0.0, 0.0]), np.array([0.0, 0.6, 0.8])
    return SimpleNamespace(system=system, initial=State(q, w * along, x * along, v * along))


def one_state(system: System) -> State:
    return random_states(case(system), 1, SEED)


@pytest.mark.parametrize("system", [FREE, PIVOTED])
def test_the_equation_itself_passes(system: System) -> None:
    states = random_states(case(system), 20, SEED)
    rows = forward_rows(system, states, forward_dynamics(system, states), "residual")
    assert [(row.gate, row.channel, row.metric, row.unit) for row in rows] == [
        ("equation", "omega_dot", "residual", "1"),
        ("equation", "linear_momentum", "residual", "1"),
    ]
    scale = body_scale(system)
    assert rows[0].bound == BOUND * (scale.largest / scale.smallest)
    assert rows[1].bound == BOUND == 64 * EPS
    assert all(row.verdict == "pass" and row.value < 8 * EPS for row in rows)


@pytest.mark.parametrize(("part", "verdict"), [(0.8, "pass"), (1.2, "fail")])
def test_omega_dot_is_held_to_its_terms(part: float, verdict: str) -> None:
    states = one_state(FREE)
    true, scale = forward_dynamics(FREE, states), body_scale(FREE)
    size = torque_size(FREE, states, true)[:, None] / scale.largest
    allowed = BOUND * scale.largest / scale.smallest * size
    off = Acceleration(true.angular + part * allowed * np.array([0.0, 0.6, -0.8]), true.linear)
    angular, linear = forward_rows(FREE, states, off, "residual")
    assert angular.value == pytest.approx(part * float(angular.bound or 0.0), rel=0.1)
    assert (angular.verdict, linear.verdict) == (verdict, "pass")


@pytest.mark.parametrize(("part", "verdict"), [(0.8, "pass"), (1.2, "fail")])
def test_the_linear_acceleration_is_held_to_its_terms(part: float, verdict: str) -> None:
    states = one_state(FREE)
    true = forward_dynamics(FREE, states)
    allowed = BOUND * linear_size(FREE, states, true)[:, None]
    off = Acceleration(true.angular, true.linear + part * allowed * np.array([0.0, 0.6, -0.8]))
    angular, linear = forward_rows(FREE, states, off, "residual")
    assert linear.value == pytest.approx(part * BOUND, rel=0.1)
    assert (angular.verdict, linear.verdict) == ("pass", verdict)


@pytest.mark.parametrize(("part", "verdict"), [(0.8, "pass"), (1.2, "fail")])
def test_a_torque_is_held_to_its_terms(part: float, verdict: str) -> None:
    states = one_state(FREE)
    requested = random_acceleration(FREE, states, SEED)
    allowed = BOUND * torque_size(FREE, states, requested)[:, None]
    torque = inverse_dynamics(FREE, states, requested)
    torque = torque + part * allowed * np.array([0.0, 0.6, -0.8])
    (row,) = inverse_rows(FREE, states, requested, torque)
    assert (row.gate, row.channel, row.metric, row.unit) == ("equation", "torque", "residual", "1")
    assert (row.bound, row.verdict) == (BOUND, verdict)
    assert row.value == pytest.approx(part * BOUND, rel=0.1)


def test_a_torque_may_come_from_places_in_the_world() -> None:
    """A small heavy body at some distance: its lever is a difference of places, and is rounded."""
    body = Body(np.array(340.0), np.array([1e-3, 2e-3, -1e-3]), np.diag([1.0, 2.0, 2.5]) * 1e-3)
    system = System((body,), Load(gravity=np.array([0.0, 1.0, -9.0])))
    states = random_states(case(system, x=30.0, w=0.1, v=0.1), 200, SEED)
    requested = random_acceleration(system, states, SEED)
    arm = rotate(states.orientation, body.center_of_mass)
    lever = states.position - (states.position - arm)  # of the place that it has from the origin's
    force = body.mass * (requested.linear - system.load.gravity)
    moved = rotate_inverse(states.orientation, cross(lever - arm, force))
    (row,) = inverse_rows(
        system, states, requested, inverse_dynamics(system, states, requested) + moved
    )
    assert 1e-3 * BOUND < row.value <= BOUND
    (wrong,) = inverse_rows(
        system, states, requested, inverse_dynamics(system, states, requested) + 1e3 * moved
    )
    assert wrong.verdict == "fail"


def test_the_worst_state_counts() -> None:
    states = random_states(case(FREE), 5, SEED)
    true = forward_dynamics(FREE, states)
    angular = true.angular.copy()
    angular[3] *= 1.001
    row = forward_rows(FREE, states, Acceleration(angular, true.linear), "residual")[0]
    expected = 1e-3 * norm(true.angular[3]) * body_scale(FREE).largest
    assert row.value == pytest.approx(expected / torque_size(FREE, states, true)[3], rel=1e-6)
    assert row.verdict == "fail"


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_one_state_without_a_number_fails(bad: float) -> None:
    states = random_states(case(FREE), 5, SEED)
    true = forward_dynamics(FREE, states)
    angular = true.angular.copy()
    angular[2, 1] = bad
    row = forward_rows(FREE, states, Acceleration(angular, true.linear), "residual")[0]
    assert np.isnan(row.value)
    assert row.verdict == "fail"


def test_where_nothing_acts_nothing_may_move() -> None:
    system = System((Body(np.array(1.0), np.zeros(3), np.eye(3)),))
    still = State(np.array([[1.0, 0, 0, 0]]), np.zeros((1, 3)), np.zeros((1, 3)), np.zeros((1, 3)))
    rest = Acceleration(np.zeros((1, 3)), np.zeros((1, 3)))
    assert [(r.value, r.verdict) for r in forward_rows(system, still, rest, "residual")] == [
        (0.0, "pass"),
        (0.0, "pass"),
    ]
    moving = Acceleration(np.full((1, 3), 1e-300), np.zeros((1, 3)))
    row = forward_rows(system, still, moving, "residual")[0]
    assert (row.unit, row.bound, row.verdict) == ("rad/s^2", 0.0, "fail")
    assert row.value == pytest.approx(np.sqrt(3.0) * 1e-300)


def test_random_states_are_about_the_scenarios_own() -> None:
    states = random_states(case(FREE), 2000, SEED)
    np.testing.assert_allclose(norm(states.orientation), 1.0, rtol=4 * EPS)
    # The median length of three standard normals is 1.538; the spread is even in its logarithm.
    assert np.median(norm(states.angular_velocity)) == pytest.approx(2.0 * 1.538, rel=0.15)
    assert np.median(norm(states.position)) == pytest.approx(5.0 * 1.538, rel=0.05)
    assert np.median(norm(states.linear_velocity)) == pytest.approx(4.0 * 1.538, rel=0.05)
    rates = np.sort(norm(states.angular_velocity) / 2.0)
    # Of a spread over [0.1, 10] times a length: a tenth lies below 0.19, a tenth above 11.
    assert rates[200] == pytest.approx(0.24, rel=0.25)
    assert rates[1800] == pytest.approx(10.0, rel=0.25)
    assert np.all(np.abs(np.mean(states.orientation, axis=0)) < 0.1)


def test_some_states_spin_about_an_axis_or_are_still() -> None:
    states = random_states(case(FREE), 200, SEED)
    zeros = np.sum(states.angular_velocity == 0.0, axis=-1)
    assert np.count_nonzero(zeros == 2) >= 3
    assert np.count_nonzero(zeros == 3) >= 1
    unmoved = np.all(states.linear_velocity == 0.0, axis=-1)
    assert np.any(unmoved & (zeros < 3))


def test_some_states_are_turned_little() -> None:
    scalar = np.abs(random_states(case(FREE), 200, SEED).orientation[:, 0])
    little = 2.0 * np.arccos(scalar[scalar > np.cos(0.15)])
    assert len(little) >= 20
    assert np.min(little) < 0.01  # there a formula of first order is off by 5e-5 at most


def test_a_body_at_rest_is_evaluated_at_rates_of_its_own() -> None:
    states = random_states(case(FREE, 0.0, 0.0, 0.0), 2000, SEED)
    gyration = np.sqrt(5.5 / 2.0)
    assert np.median(norm(states.angular_velocity)) == pytest.approx(1.538, rel=0.15)
    assert np.median(norm(states.position)) == pytest.approx(gyration * 1.538, rel=0.05)
    assert np.median(norm(states.linear_velocity)) == pytest.approx(gyration * 1.538, rel=0.05)
    faster = random_states(case(FREE, 3.0, 0.0, 0.0), 2000, SEED)
    assert np.median(norm(faster.linear_velocity)) == pytest.approx(3 * gyration * 1.538, rel=0.05)


def test_the_same_seed_evaluates_the_same_states() -> None:
    one, other = random_states(case(PIVOTED), 5, SEED), random_states(case(PIVOTED), 5, SEED)
    np.testing.assert_array_equal(one.orientation, other.orientation)
    placed = place_on_pivot(PIVOTED, one)
    np.testing.assert_array_equal(one.position, placed.position)
    assert not np.array_equal(one.orientation, random_states(case(PIVOTED), 5, (1,)).orientation)


def test_inverse_dynamics_is_evaluated_for_what_no_load_gives() -> None:
    states = random_states(case(FREE), 500, SEED)
    requested, free = random_acceleration(FREE, states, SEED), forward_dynamics(FREE, states)
    rate = norm(states.angular_velocity) ** 2
    gyration = np.sqrt(np.trace(BODY.inertia) / BODY.mass)  # a length makes an acceleration of it
    for extra in (requested.angular - free.angular, (requested.linear - free.linear) / gyration):
        turns = rate > 0.0
        assert np.median(norm(extra[turns]) / rate[turns]) == pytest.approx(1.538, rel=0.1)
    states = random_states(case(PIVOTED), 500, SEED)
    requested = random_acceleration(PIVOTED, states, SEED)
    extra = requested.angular - forward_dynamics(PIVOTED, states).angular
    rate = norm(states.angular_velocity) ** 2
    turns = rate > 0.0
    assert np.median(norm(extra[turns]) / rate[turns]) == pytest.approx(1.538, rel=0.1)
    carried = center_of_mass_acceleration(PIVOTED, states, requested.angular)
    np.testing.assert_array_equal(requested.linear, carried)


@pytest.mark.parametrize("system", [FREE, PIVOTED])
def test_what_a_run_reports_of_omega_dot_has_the_same_bound(system: System) -> None:
    states = random_states(case(system), 6, SEED)
    (row,) = reported_rows(system, states, forward_dynamics(system, states).angular)
    (same, _) = forward_rows(system, states, forward_dynamics(system, states), "residual")
    assert (row.metric, row.verdict) == ("residual_in_run", "pass")
    assert row.bound == same.bound
    assert row.value < 8 * EPS


def test_states_that_are_not_finite_are_left_to_others() -> None:
    states = random_states(case(FREE), 6, SEED)
    reported = forward_dynamics(FREE, states).angular
    reported[2] = np.nan
    states.angular_velocity[3, 0] = 1e200  # its square overflows
    states.orientation[4] = np.inf
    (row,) = reported_rows(FREE, states, reported)
    assert row.verdict == "pass"
    assert reported_rows(FREE, states, np.full_like(reported, np.nan)) == []
    reported[5] *= 1.0 + 1e-9
    assert reported_rows(FREE, states, reported)[0].verdict == "fail"


def test_where_squares_underflow_omega_dot_is_not_judged() -> None:
    """Damping brings a body there; a residual is relative to the size of terms that are zero."""
    damped = System(PIVOTED.bodies, Load(pivot=PIVOTED.load.pivot, damping=np.array(0.3)))
    states = random_states(case(damped), 6, SEED)
    states.angular_velocity[1] *= 1e-170 / norm(states.angular_velocity[1])
    reported = forward_dynamics(damped, states).angular
    reported[1] *= 1.0 + EPS
    assert reported_rows(damped, states, reported)[0].verdict == "pass"
    states.angular_velocity[2] = 0.0
    reported[2] = 1e-30  # at rest nothing acts
    assert reported_rows(damped, states, reported)[0].verdict == "fail"
