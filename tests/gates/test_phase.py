"""Right but late is distinguished from wrong: shifts, what is left of them, flips."""

from dataclasses import replace

import numpy as np
import pytest
from in_process import builtin, truth_of

from omegadot.gates.errors.measured_run import measure
from omegadot.gates.runs import phase
from omegadot.gates.runs.interpolation import Hermite, error_factor, zero_crossings
from omegadot.reference_impl.closed_forms import problem_of
from omegadot.reference_impl.closed_forms.digits import many_digits
from omegadot.reference_impl.closed_forms.euler_poinsot import constants_of
from omegadot.reference_impl.closed_forms.free_rotation import inertia_and_omega
from omegadot.reference_impl.rotations import turn_in_body
from omegadot.reference_impl.solutions.exact_solution import exact_solution
from omegadot.reference_impl.system import State


def exact_at(case, times):
    """The exact states at times that may lie before the start."""
    first = min(0.0, float(times[0]))
    early = exact_solution(case.system, case.initial, np.array([first])).state
    start = State(*(values[0] for values in vars(early).values()))
    return exact_solution(case.system, start, times - first).state


def measured(case, truth, state):
    sweep = case.sweeps[0]
    run = measure(truth, sweep, state, None)
    return {row.metric: row for row in phase.rows(truth, run, state)}


@pytest.fixture(scope="module")
def brick():
    case = builtin("nesc-checkcase-2")
    return case, truth_of(case, ())


@pytest.fixture(scope="module")
def handle():
    case = builtin("t-handle")
    return case, truth_of(case, ())


@pytest.mark.parametrize("late", [0.32e-3, -0.32e-3, 1.7e-2, 0.5])
def test_a_motion_that_is_merely_late_is_recognised(brick, handle, late):
    for case, truth in (brick, handle):
        rows = measured(case, truth, exact_at(case, case.sweeps[0].times - late))
        shift, left = rows["time_shift"], rows["residual_after_shift"]
        assert abs(shift.value + late) <= shift.bound < 1e-3 * abs(late)
        assert left.value <= left.bound
        assert shift.note.startswith("late" if late > 0 else "early")
        assert rows["flip_time_error"].value == pytest.approx(abs(late), abs=1e-5)
        assert {row.verdict for row in rows.values()} == {"info"}


def test_nasas_late_trace_is_clean_once_shifted(brick):
    case, truth = brick
    rows = measured(case, truth, exact_at(case, case.sweeps[0].times - 0.32e-3))
    left = rows["residual_after_shift"]
    assert float(left.note.split()[0]) > 5e-5
    assert left.value < 1e-11
    # The cubic is this good near a sample; in the middle of a gap it leaves 1e-7.
    assert left.bound < 1e-10


def test_a_wrong_size_is_not_mistaken_for_lateness(brick):
    case, truth = brick
    exact = truth.at(case.sweeps[0])
    rows = measured(case, truth, replace(exact, angular_velocity=1.001 * exact.angular_velocity))
    assert abs(rows["time_shift"].value) < 1e-4
    assert rows["residual_after_shift"].value == pytest.approx(1e-3, rel=0.05)
    assert rows["flip_time_error"].value < 1e-4


def test_a_clock_that_runs_slow_makes_the_flips_late(handle):
    case, truth = handle
    times = case.sweeps[0].times
    slow = exact_at(case, 0.999 * times)
    spin = replace(slow, angular_velocity=0.999 * slow.angular_velocity)
    flip = measured(case, truth, spin)["flip_time_error"]
    first, period = flips_of(truth, case)[0], flip_period(case)
    last = first + period * np.floor((times[-1] - first) / period)
    assert flip.value == pytest.approx(1e-3 * last, rel=0.01)
    assert "flips: 3, in the exact motion: 3" in flip.note


def flips_of(truth, case):
    axis = phase.middle_axis(case.system)
    omega, slope = truth.state.angular_velocity @ axis, truth.omega_dot @ axis
    return zero_crossings(truth.times, omega, slope)


def flip_period(case):
    """``2K/λ`` s: half a period of Jacobi's functions."""
    with many_digits():
        c = constants_of(*inertia_and_omega(problem_of(case.system, case.initial).numbers))
        return float(2 * c.modulus.quarter / c.rate)


def test_flips_come_as_often_as_the_closed_form_gives(handle):
    case, truth = handle
    assert np.diff(flips_of(truth, case)) == pytest.approx(flip_period(case), abs=1e-5)


def test_flips_that_are_missing_are_reported(handle):
    case, truth = handle
    exact = truth.at(case.sweeps[0])
    still = np.broadcast_to(exact.angular_velocity[0], exact.angular_velocity.shape)
    flip = measured(case, truth, replace(exact, angular_velocity=still))["flip_time_error"]
    assert flip.value == np.inf
    assert flip.note == "flips: 0, in the exact motion: 3"


@pytest.mark.parametrize("name", ["sphere", "principal-spin-middle"])
def test_a_constant_omega_has_no_phase(name):
    case = builtin(name)
    truth = truth_of(case, ())
    assert measured(case, truth, truth.at(case.sweeps[0])) == {}


def test_a_symmetric_body_turns_but_does_not_flip():
    case = builtin("symmetric-top")
    truth = truth_of(case, ())
    assert set(measured(case, truth, truth.at(case.sweeps[0]))) == {
        "time_shift",
        "residual_after_shift",
    }


def test_a_motion_that_has_blown_up_is_left_alone(brick):
    case, truth = brick
    exact = truth.at(case.sweeps[0])
    wild = exact.angular_velocity.copy()
    wild[5:] *= 1e300
    with np.errstate(over="ignore"):
        assert measured(case, truth, replace(exact, angular_velocity=wild)) == {}


def test_a_period_more_is_not_taken_for_the_shift():
    # Ten samples early fits as well as 0.45 of one late, and falls on a sample.
    times, rate = np.arange(101.0), 2 * np.pi / 10.45

    def circling(t):
        return np.stack([np.cos(rate * t), np.sin(rate * t), np.zeros_like(t)], axis=-1)

    exact = Hermite(times, circling(times), rate * circling(times + 10.45 / 4))
    assert phase.best_shift(exact, circling(times - 0.45)).shift == pytest.approx(-0.45, abs=1e-3)


def test_the_attitude_is_not_used_in_the_shift(brick):
    case, truth = brick
    exact = truth.at(case.sweeps[0])
    turned = turn_in_body(exact.orientation, exact.angular_velocity, 0.1)
    rows = measured(case, truth, replace(exact, orientation=turned))
    assert rows["time_shift"].value == pytest.approx(0.0, abs=1e-14)


def test_a_cubic_is_followed_exactly_and_a_quartic_to_its_error():
    times = np.array([0.0, 0.5, 1.5, 2.0])
    at = np.linspace(0.0, 2.0, 41)

    def curve(power):
        return Hermite(times, times[:, None] ** power, power * times[:, None] ** (power - 1))

    value, slope = curve(3).at(at)
    assert value[:, 0] == pytest.approx(at**3, abs=1e-14)
    assert slope[:, 0] == pytest.approx(3 * at**2, abs=1e-13)
    value, _ = curve(4).at(np.array([0.75]))  # a quarter into a gap of one second
    assert abs(value[0, 0] - 0.75**4) == pytest.approx(24 * error_factor(0.25), rel=1e-12)


def test_zeros_are_found_between_samples_only_where_the_sign_changes():
    times = np.linspace(0.0, 10.0, 101)
    found = zero_crossings(times, np.sin(times), np.cos(times))
    assert found == pytest.approx([np.pi, 2 * np.pi, 3 * np.pi], abs=1e-6)
    for never in (np.sin(times) + 2.0, np.abs(np.round(np.sin(times), 1)), np.zeros(101)):
        assert len(zero_crossings(times, never, np.cos(times))) == 0


def test_a_zero_that_newton_alone_would_miss_is_found():
    times, values, slopes = np.array([0.0, 1.0]), np.array([-1.0, 4.4]), np.array([-26.0, -27.0])
    (found,) = zero_crossings(times, values, slopes)
    left, _ = Hermite(times, values[:, None], slopes[:, None]).at(np.array([found]))
    assert 0.0 < found < 1.0
    assert abs(left[0, 0]) < 1e-6
