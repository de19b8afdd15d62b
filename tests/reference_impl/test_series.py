"""The Taylor series against forty digits, against elementary motions, and against itself."""

from __future__ import annotations

import numpy as np
import pytest
from many_digits import exact_states
from reference_cases import DAMPED, DRIVEN, EPS, FREE, TOP, rows, start, system, turned

from omegadot.reference_impl.arithmetic.precision import extended, to_double, to_extended
from omegadot.reference_impl.energy import total_energy
from omegadot.reference_impl.from_scenario import initial_state_of, system_of
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.momentum import angular_momentum
from omegadot.reference_impl.rotations import (
    attitude_angle,
    exp_quaternion,
    quaternion_product,
    rotation_matrix,
)
from omegadot.reference_impl.solutions import series
from omegadot.reference_impl.solutions.series import solve_extended, solve_series
from omegadot.reference_impl.system import Array, State, System
from omegadot.scenarios import builtin_names, load_builtin

# The built-in scenarios run in the platform's own type: in both they would take too long here.
in_both_types = pytest.mark.usefixtures("extended_type_of_truth")

TRUTHS: dict[str, tuple[System, State, float]] = {
    "triaxial": (system(turned([1, 2, 2.5])), start([1, 2, -1.5], [1, 2, 3, 4]), 3.0),
    "heavy-top": (TOP, start([0.3, 0.4, 12.0], [1, 0.3, 0.1, 0], on=TOP), 1.0),
    "damped": (DAMPED, start([2.0, 1.5, 1.0], [1, 0, 1, 0]), 3.0),
    "driven": (DRIVEN, start([1.0, -1.0, 1.5]), 2.0),
    "thin-bar": (system(turned([1e-6, 1, 1])), start([1, 2, 1]), 5.0),
    "thin-bar-driven": (
        system(turned([1e-6, 1, 1]), damping=1e-7, torque_world=(0, 0, 1e-7)),
        start([1, 2, 1]),
        3.0,
    ),
    "backwards": (system(turned([1, 2, 2.5]), damping=0.1), start([1, 2, -1.5]), -3.0),
    "offset-pivot": (
        system(
            turned([0.1, 0.2, 0.25]), 2.0, (0.1, -0.2, 0.3),
            pivot=(0.1, 0.3, 0), gravity=(0, 0, -9.8), damping=0.05,
            torque_body=(0.1, 0, 0.2), torque_world=(0, 0.3, 0),
        ),
        start([1, 2, 3], [1, 1, 0, 0.5]),
        2.0,
    ),
}  # fmt: skip


@in_both_types
@pytest.mark.parametrize("name", TRUTHS)
def test_forty_digits_agree(name: str) -> None:
    on, initial, end = TRUTHS[name]
    times = np.array([0.3 * end, end])
    found = solve_extended(on, initial, times)
    for n, (R, w) in enumerate(exact_states(on, initial, times)):
        # 1e-12 is requested; either type leaves four digits more
        assert largest(found.angular_velocity[n] - w) <= 1e-16 * largest(w)
        assert largest(rotation_matrix(found.orientation[n]) - R) <= 1e-16
        kept = solve_series(on, initial, times)
        assert kept.angular_velocity.dtype == kept.position.dtype == np.float64
        assert np.array_equal(kept.angular_velocity, to_double(found.angular_velocity))


def largest(values: Array) -> float:
    return float(np.max(np.abs(to_double(values))))


@pytest.mark.parametrize("name", builtin_names())
def test_built_in_scenarios_are_good_to_1e13(name: str) -> None:
    scenario = load_builtin(name)
    on, initial = system_of(scenario), initial_state_of(scenario)
    # a second at most, to keep forty digits affordable; the next test runs over the whole
    end = min(scenario.run.duration, 1.0)
    found = solve_series(on, initial, np.array([end]))
    ((R, w),) = exact_states(on, initial, [end])
    size = max(largest(w), largest(initial.angular_velocity))
    assert largest(found.angular_velocity[0] - w) <= 1e-13 * size
    assert largest(rotation_matrix(found.orientation[0]) - R) <= 1e-13


@pytest.mark.parametrize("name", builtin_names())
def test_built_in_scenarios_run_back_to_their_start(name: str) -> None:
    scenario = load_builtin(name)
    on, initial = system_of(scenario), initial_state_of(scenario)
    there = rows(solve_extended(on, initial, np.array([scenario.run.duration])), 0)
    back = rows(solve_series(on, there, np.array([-scenario.run.duration])), 0)
    size = np.max(np.abs(initial.angular_velocity))
    assert np.max(np.abs(back.angular_velocity - initial.angular_velocity)) <= 1e-13 * size
    assert attitude_angle(back.orientation, initial.orientation) <= 1e-13


@in_both_types
@pytest.mark.parametrize("on", [FREE, TOP], ids=["free", "top"])
def test_energy_and_momentum_stand_still(on: System) -> None:
    initial = start([0.3, 2.0, 3.0], [1, 0.3, 0.1, 0], velocity=(1, 2, 3), on=on)
    states = solve_extended(on, initial, np.linspace(-5, 20, 300))
    long = extended(on)
    energy, momentum = total_energy(long, states), angular_momentum(long, states)
    assert largest(energy / energy[0] - 1.0) <= 1e-16
    # about the vertical alone where the weight has a moment
    up = to_extended(on.load.gravity)
    kept = momentum @ up if on is TOP else momentum
    assert largest(kept - kept[0]) <= 1e-16 * largest(kept)


def test_symmetric_top_is_two_turns() -> None:
    # free precession: q(t) = q0 exp-in-world(t L/I1) exp-in-body(t n), n = (1 - I3/I1) w3 along z
    on, t = system([2.0, 2.0, 1.0]), np.linspace(-10, 30, 41)
    initial = start([1.0, 0.5, 5.0], [1, 2, 3, 4])
    found = solve_series(on, initial, t)
    momentum = angular_momentum(on, initial)
    spin = (1 - 1.0 / 2.0) * 5.0
    q = quaternion_product(
        quaternion_product(exp_quaternion(t[:, None] * momentum / 2.0), initial.orientation),
        exp_quaternion(t[:, None] * np.array([0.0, 0.0, spin])),
    )
    # the formula in double rounds angles of up to 150 rad
    assert np.max(attitude_angle(found.orientation, q)) <= 16 * EPS * 30 * 5.2
    phase = -spin * t
    w_x = np.cos(phase) * 1.0 - np.sin(phase) * 0.5
    w_y = np.sin(phase) * 1.0 + np.cos(phase) * 0.5
    w = np.stack([w_x, w_y, np.full_like(t, 5.0)], axis=-1)
    assert np.max(np.abs(found.angular_velocity - w)) <= 16 * EPS * 30 * 5.2


def test_driven_sphere_and_damped_sphere_are_elementary() -> None:
    t = np.linspace(-3, 3, 13)
    driven = solve_series(system([2.0, 2, 2], torque_body=(0, 0, 3)), start([0, 0, 1]), t)
    assert np.max(np.abs(driven.angular_velocity[:, 2] - (1 + 1.5 * t))) <= 4 * EPS * 6
    turned_by = exp_quaternion(np.outer(t + 0.75 * t**2, [0, 0, 1.0]))
    assert np.max(attitude_angle(driven.orientation, turned_by)) <= 8 * EPS * 10
    w = np.array([1.0, 2.0, 3.0])
    damped = solve_series(system([2.0, 2, 2], damping=0.5), start(w), t)
    decay = np.exp(-0.25 * t)[:, None]
    assert np.max(np.abs(damped.angular_velocity - decay * w)) <= 4 * EPS * 3 * np.exp(0.75)


@in_both_types
def test_free_fall_is_a_parabola_and_a_pivoted_body_stays_on_its_pivot() -> None:
    t = np.array([0.5, -1.0, 2.0])
    initial = start([1, 2, 3], position=(1, 2, 3), velocity=(4, 5, 6))
    found = solve_series(FREE, initial, t)
    g = np.array([0, 0, -9.81])
    assert np.array_equal(found.linear_velocity, [4, 5, 6] + t[:, None] * g)
    expected = np.array([1, 2, 3]) + np.outer(t, [4, 5, 6]) + np.outer(t**2 / 2, g)
    assert np.max(np.abs(found.position - expected)) <= 4 * EPS * 20
    pivoted = solve_series(TOP, start([1, 2, 3], on=TOP), t)
    placed = place_on_pivot(TOP, pivoted)
    assert np.max(np.abs(pivoted.position - placed.position)) <= 8 * EPS
    assert np.max(np.abs(pivoted.linear_velocity - placed.linear_velocity)) <= 32 * EPS


@in_both_types
def test_any_order_of_times_repeated_and_of_either_sign() -> None:
    t = np.array([3.0, -2.0, 0.0, 5.0, 3.0, -7.0, 1e-3])
    initial = start([1, 2, -1.5], [1, 2, 3, 4])
    together = solve_series(FREE, initial, t)
    for n, time in enumerate(t):
        alone = rows(solve_series(FREE, initial, np.array([time])), 0)
        # the last step is cut differently; both are rounded from extended precision
        gap = np.abs(alone.angular_velocity - together.angular_velocity[n])
        assert np.max(gap) <= 4 * EPS
    assert np.array_equal(together.angular_velocity[0], together.angular_velocity[4])
    assert np.array_equal(together.angular_velocity[2], initial.angular_velocity)
    assert solve_series(FREE, initial, np.zeros(0)).orientation.shape == (0, 4)


@in_both_types
@pytest.mark.parametrize("on", [FREE, TOP, DRIVEN, DAMPED], ids=["free", "top", "driven", "damped"])
def test_lanes_are_the_single_solutions(on: System) -> None:
    rng = np.random.default_rng(4)
    q = rng.normal(size=(2, 3, 4))
    lanes = start(2 * rng.normal(size=(2, 3, 3)), q / np.linalg.norm(q, axis=-1, keepdims=True))
    t = np.array([1.5, -0.5])
    together = solve_series(on, lanes, t)
    assert together.orientation.shape == (2, 2, 3, 4)
    assert together.position.shape == (2, 2, 3, 3)
    for i in range(2):
        for j in range(3):
            one = State(
                lanes.orientation[i, j], lanes.angular_velocity[i, j], np.zeros(3), np.zeros(3)
            )
            alone = solve_series(on, one, t)
            gap = np.abs(alone.angular_velocity - together.angular_velocity[:, i, j])
            assert np.max(gap) <= 4 * EPS * np.max(np.abs(alone.angular_velocity))
            angle = attitude_angle(alone.orientation, together.orientation[:, i, j])
            assert np.max(angle) <= 4 * EPS


@in_both_types
def test_a_body_at_rest_stays_at_rest_for_ever() -> None:
    found = solve_series(system([1, 2, 2.5]), start([0, 0, 0], [1, 2, 3, 4]), np.array([1e9, -1e9]))
    assert not np.any(found.angular_velocity)
    assert (
        np.max(attitude_angle(found.orientation, start([0, 0, 0], [1, 2, 3, 4]).orientation)) <= EPS
    )


@in_both_types
def test_magnitudes_far_from_one_are_no_matter() -> None:
    # a hydrogen molecule's inertia and rate: the same motion in other units
    slow = solve_series(system([1, 2, 2.5]), start([1, 2, 3]), np.array([2.0]))
    fast = solve_series(
        system(np.array([1, 2, 2.5]) * 2.0**-156),
        start(np.array([1, 2, 3]) * 2.0**43),
        np.array([2.0**-42]),
    )
    gap = np.abs(fast.angular_velocity * 2.0**-43 - slow.angular_velocity)
    assert np.max(gap) <= 4 * EPS * 3


@pytest.mark.parametrize(
    ("on", "initial", "times", "message"),
    [
        (FREE, start([np.nan, 0, 0]), [1.0], "finite"),
        (FREE, start([1, 0, 0]), [np.inf], "finite"),
        (FREE, start([1, 0, 0]), [[1.0]], "list"),
        (system(np.ones((2, 3, 3))), start([1, 0, 0]), [1.0], "one system"),
    ],
)
def test_what_cannot_be_solved_is_refused(
    on: System, initial: State, times: object, message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        solve_series(on, initial, np.array(times))


@in_both_types
def test_numbers_out_of_range_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    # what is not a number must end the march, not prolong it
    monkeypatch.setattr(series, "_step_length", lambda _: float("nan"))
    with pytest.raises(ArithmeticError, match="leaves the range of numbers"):
        solve_series(FREE, start([1, 2, 3]), np.array([1.0]))
