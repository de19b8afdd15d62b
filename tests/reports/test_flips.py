"""Flips are counted where the body turns over, and a wobble is none."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from omegadot.reference_impl.from_scenario import initial_state_of, system_of
from omegadot.reference_impl.solutions.exact_solution import exact_states
from omegadot.reference_impl.system import Array, Body, Load, System
from omegadot.reports.summary.flips import Flip, Flips, flip_axis, flips_of, turned_over
from omegadot.scenarios import load_builtin

# Moments 1, 2, 3: the middle axis is z.
SYSTEM = System((Body(np.array(1.0), np.zeros(3), np.diag([1.0, 3.0, 2.0])),))


def of_angles(degrees: list[float], time: Array | None = None) -> Flips:
    """The flips of a body whose H is so far from its middle axis, sample by sample, 1 s apart."""
    angle = np.deg2rad(degrees)
    momentum = np.stack([np.sin(angle), 0 * angle, np.cos(angle)], axis=-1)
    omega = 7.0 * momentum / [1.0, 3.0, 2.0]
    found = flips_of(np.arange(len(angle), dtype=float) if time is None else time, omega, SYSTEM)
    assert found is not None
    return found


def exact_flips(name: str) -> Flips | None:
    scenario = load_builtin(name)
    system, time = system_of(scenario), np.linspace(0.0, scenario.run.duration, 401)
    _, states = exact_states(system, initial_state_of(scenario), time)
    return flips_of(time, states.angular_velocity, system)


def test_the_t_handle_flips_at_even_intervals() -> None:
    """Its elliptic functions have one period: flips are half of it apart."""
    found = exact_flips("t-handle")
    assert found is not None
    times = [flip.time for flip in found.flips]
    assert len(times) == 3
    # Linear between samples 0.02 s apart, of a curve odd about its zero: the cube of the gap.
    assert times[1] - times[0] == pytest.approx(times[2] - times[1], abs=1e-3)
    for flip in found.flips:
        assert flip.start < flip.time < flip.end
        # Even about its middle, to the samples, which are 0.02 s apart.
        assert flip.time - flip.start == pytest.approx(flip.end - flip.time, abs=0.0201)


@pytest.mark.parametrize("name", ["principal-spin-major", "principal-spin-minor", "free-bar"])
def test_a_spin_about_another_axis_flips_nothing(name: str) -> None:
    assert exact_flips(name) == Flips((), load_builtin(name).run.duration)


@pytest.mark.parametrize("name", ["heavy-top", "sphere", "symmetric-top", "damped-tumble"])
def test_where_a_torque_acts_or_moments_are_equal_none_are_counted(name: str) -> None:
    """Caught: a pendulum's swings, and the precession of a top, as flips."""
    assert exact_flips(name) is None


def test_gravity_turns_no_body_that_is_free_or_held_at_its_centre() -> None:
    down = Load(gravity=np.array([0.0, 0.0, -9.8]))
    for load in (down, replace(down, pivot=np.zeros(3))):
        axis = flip_axis(replace(SYSTEM, load=load))
        assert axis is not None
        assert np.abs(axis) == pytest.approx([0.0, 0.0, 1.0])
    assert flip_axis(replace(SYSTEM, load=replace(down, pivot=np.array([0.1, 0.0, 0.0])))) is None


def test_a_wobble_changes_the_sign_and_is_no_flip() -> None:
    """Caught: every sign change counted, as of a body that now spins about another axis."""
    assert of_angles([10, 80, 100, 80, 100, 80]).flips == ()
    (flip,) = of_angles([10, 80, 100, 80, 100, 170]).flips
    assert flip.time == pytest.approx(3.5)  # the last change of the three


def test_a_flip_starts_and_ends_at_45_degrees_from_the_axis() -> None:
    (flip,) = of_angles([0, 44, 46, 134, 136, 180]).flips
    assert (flip.start, flip.end) == (1.0, 4.0)
    assert flip.time == pytest.approx(2.5)
    back = of_angles([180, 120, 60, 0, 60, 120, 180]).flips
    assert [one.time for one in back] == pytest.approx([1.5, 4.5])


def test_at_the_end_half_a_flip_counts_if_the_sign_changed_once() -> None:
    (half,) = of_angles([0, 60, 100]).flips
    assert half.end == math.inf
    assert of_angles([0, 60, 80]).flips == ()


def test_a_run_that_blew_up_or_rests_has_no_flip_there() -> None:
    omega = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, np.nan], [0.0, 0.0, -1.0]])
    assert flips_of(np.arange(3.0), omega, SYSTEM) == Flips((), 0.0)
    assert flips_of(np.arange(2.0), omega[1:], SYSTEM) == Flips((), -math.inf)
    for sign in (1.0, -1.0):
        rest = np.array([[0.0, 0.0, sign], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
        assert flips_of(np.arange(3.0), rest, SYSTEM) == Flips((), 2.0)
    huge = flips_of(np.arange(2.0), np.array([[0.0, 0.0, 1e300], [0.0, 0.0, -1e300]]), SYSTEM)
    assert huge is not None
    assert [flip.time for flip in huge.flips] == [0.5]


TIME = np.linspace(0.0, 8.0, 401)


def turning(period: float = 4.0) -> Array:
    """Omega that turns from z to x and on: its z changes sign at period/4, and every period/2."""
    angle = 2.0 * np.pi * TIME / period
    return np.stack([np.sin(angle), np.zeros_like(angle), np.cos(angle)], -1)


def test_flips_are_found_between_samples_and_in_a_body_that_is_braked() -> None:
    # linear between samples, of a cosine near its zero: off by (w dt)^3 / 16, less than 2e-6 s
    for speed in (1.0, np.exp(-2.0 * TIME)[:, None]):
        found = flips_of(TIME, speed * turning(), SYSTEM)
        assert found is not None
        assert found.times == pytest.approx([1.0, 3.0, 5.0, 7.0], abs=1e-5)
    turned = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    inertia = turned @ SYSTEM.body.inertia @ turned.T
    other = System((replace(SYSTEM.body, inertia=inertia),))
    found = flips_of(TIME, turning() @ turned.T, other)
    assert found is not None
    assert found.times == pytest.approx([1.0, 3.0, 5.0, 7.0], abs=1e-5)


def test_a_body_that_wobbles_across_or_spins_elsewhere_does_not_flip() -> None:
    noise = 0.4 * np.sin(40.0 * TIME)
    across = np.stack([np.ones_like(TIME), np.zeros_like(TIME), noise], -1)
    for omega in (across, np.tile([0.0, 0.1, 9.0], (401, 1)), np.zeros((401, 3))):
        assert flips_of(TIME, omega, SYSTEM) == Flips((), 8.0)


def test_what_follows_a_sample_that_is_not_finite_is_left_out() -> None:
    omega = turning()
    omega[TIME > 4.0] = np.nan
    found = flips_of(TIME, omega, SYSTEM)
    assert found is not None
    assert (len(found.flips), found.until) == (2, 4.0)
    omega[10] = np.inf
    assert flips_of(TIME, omega, SYSTEM) == Flips((), TIME[9])


EXACT = Flips((Flip(1.0, 1.5, 2.0), Flip(4.0, 4.5, 5.0), Flip(7.0, 7.5, math.inf)), 8.0)


@pytest.mark.parametrize(
    ("times", "until", "expected"),
    [
        ([1.4, 4.7], 8.0, "yes"),
        ([1.4, 4.7, 7.9], 8.0, "yes"),
        ([2.9, 3.1], 8.0, "yes"),  # the middles are 3 and 6
        ([], 8.0, "never"),
        ([], 3.0, "never"),
        ([], 1.9, None),
        ([1.5], 3.0, "yes"),
        ([1.5], 8.0, "late"),
        ([3.1, 4.5], 8.0, "late"),
        ([1.5, 6.1], 8.0, "late"),
        ([3.0], 3.0, "late"),
        ([1.5, 2.9], 8.0, "early"),
        ([1.5, 2.9], 3.0, "early"),
        ([1.5, 4.5, 5.9], 8.0, "early"),
        ([1.5, 4.5, 7.5, 7.9], 8.0, "early"),
    ],
)
def test_whether_a_run_turns_over_as_the_exact_motion_does(
    times: list[float], until: float, expected: str | None
) -> None:
    assert turned_over(times, until, EXACT) == expected


@pytest.mark.parametrize(
    ("times", "expected"),
    [
        ((1.1, 3.2, 5.9), "yes"),
        ((1.9, 2.1, 7.9), "yes"),
        ((), "never"),
        ((1.1, 3.2), "late"),
        ((2.5, 3.2, 5.0), "late"),
        ((1.1, 1.9, 3.0, 5.0), "early"),
        ((1.0, 3.0, 5.0, 7.0), "early"),
        ((1.0, 4.5, 5.0), "late"),
    ],
)
def test_flips_are_in_time_where_each_is_the_one_of_its_part(
    times: tuple[float, ...], expected: str
) -> None:
    exact = Flips(tuple(Flip(time - 0.3, time, time + 0.3) for time in (1.0, 3.0, 5.0)), 8.0)
    assert turned_over(times, 8.0, exact) == expected


def test_a_motion_without_flips_asks_for_none() -> None:
    assert turned_over(EXACT.times, 8.0, Flips((), 8.0)) is None
