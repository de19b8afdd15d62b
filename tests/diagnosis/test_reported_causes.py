"""Causes in what a run reports: its times, its axes, how it was requested; and silence."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from wrong_equations import CASES

from omegadot.diagnosis.equations.evidence import of_forward_dynamics
from omegadot.diagnosis.models.fitted_misreadings import fitted_misreadings
from omegadot.diagnosis.models.misreadings import misreadings
from omegadot.diagnosis.reported.clock import clock_cause, clock_of_runs
from omegadot.diagnosis.reported.of_steps import ways_of_steps
from omegadot.diagnosis.reported.requests import again_cause, place_cause
from omegadot.diagnosis.reported.singles import fields_in_single
from omegadot.diagnosis.stepping.explicit_schemes import scheme_named
from omegadot.diagnosis.stepping.slips.slips import OF_SCHEME, slipped
from omegadot.diagnosis.wording.conditions import only_where
from omegadot.diagnosis.wording.kinds import agreed, is_fact, kind_of
from omegadot.gates.bounds.scales import EPS
from omegadot.gates.case import Case, Sweep
from omegadot.gates.rows import Row
from omegadot.gates.states.equation import random_states
from omegadot.harness.arguments import case_of
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.one_body.body_motion import attitude_motion
from omegadot.reference_impl.rotations import quaternion_product, rotate, rotation_matrix
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Acceleration, Array, State
from omegadot.scenarios import scenario
from omegadot.written import written

SWEEP = Sweep(0.0371234567, 40, 4)
CLOCKS = {
    "late": (lambda t: t + 0.01, "every time is reported 0.01 s late"),
    "milliseconds": (lambda t: 1e3 * t, "the times are reported in milliseconds"),
    "slow": (lambda t: 1.001 * t, "every time is too large, by 0.001 of it"),
    "single": (lambda t: t.astype(np.float32).astype(float), "kept in single precision"),
    "micro": (lambda t: np.floor(t * 1e6) / 1e6, "the times are whole microseconds"),
    "huge": (
        lambda t: np.append(t[:-1], 1e300),
        f"the last time alone is off: 1e300 s, where {written(SWEEP.times[-1])} s was due",
    ),
    "last": (lambda t: np.append(t[:-1], t[-1] + 0.1), "the last time alone is off"),
    "missing": (lambda t: t[:-1], "the last sample is missing"),
    "reversed": (lambda t: t[::-1], "the samples come in the opposite order"),
    "right": (lambda t: t * (1.0 + EPS), ""),
    "running sum": (lambda t: t + EPS * t * np.arange(len(t)) / len(t) * 10.0, ""),
}


@pytest.mark.parametrize(
    ("turned", "phrase"),
    [(False, "not turned into the world: it is off by c - R c"), (True, "in it once too often")],
)
def test_a_centre_of_mass_that_is_added_wrongly_is_a_way_to_misread_a_place(
    turned: bool, phrase: str
) -> None:
    """Of a place x: x - R c + c, and x + R c."""
    states, c = random_states(CASES[0], 8, [1]), CASES[0].system.body.center_of_mass
    at = rotate(states.orientation, c)
    reported = replace(states, position=states.position + (at if turned else c - at))
    (way,) = [one for one in misreadings(CASES[0].system) if phrase in one.statement]
    assert np.allclose(way.right(reported).position, states.position, rtol=0.0, atol=1e-14)


def test_a_last_time_on_the_grid_of_the_samples_is_named() -> None:
    """Caught: that it alone is off, by another number in each run."""
    sweep = Sweep(0.0371234567, 41, 4)
    whole = np.append(sweep.times[:-1], 44 * sweep.timestep)
    text = "the last time is a whole interval after the one before, though fewer steps lead to it"
    assert clock_cause(whole, sweep, EPS) == text
    assert "alone is off" in clock_cause(whole + np.append(np.zeros(11), 1e-3), sweep, EPS)


@pytest.mark.parametrize("name", CLOCKS)
def test_the_fault_of_a_clock_is_named(name: str) -> None:
    change, phrase = CLOCKS[name]
    found = clock_cause(change(SWEEP.times), SWEEP, EPS)
    assert (phrase in found) if phrase else found == ""


def summed(sweep: Sweep) -> Array:
    """The clock is summed step by step in single precision."""
    steps = np.full(int(sweep.sample_steps[-1]), sweep.timestep, np.float32)
    sums = np.concatenate(([np.float32(0.0)], np.cumsum(steps, dtype=np.float32)))
    return np.asarray(sums[sweep.sample_steps].astype(float))


def test_a_sum_in_single_precision_is_no_factor() -> None:
    """Caught: "every time is too small, by 1.94e-8 of it", of sums of a few equal steps."""
    short = Sweep(SWEEP.timestep, 2, 1)
    for sweep in (short, SWEEP):
        assert clock_cause(summed(sweep), sweep, EPS) == "the times are kept in single precision"
    odd = Sweep(1e-3, 3, 1)  # by a factor that makes singles: they are too far off for rounding
    found = clock_cause(250.0 * odd.times, odd, EPS)
    assert found == "every time is scaled by 250"


def test_a_factor_of_the_clock_is_one_of_every_run() -> None:
    """Caught: the factor of the coarsest run alone."""
    fine = Sweep(SWEEP.timestep / 2.0, 80, 8)
    fast, right = ((k * SWEEP.times, SWEEP) for k in (1.001, 1.0))
    both = [fast, (1.001 * fine.times, fine)]
    factor, seen = clock_of_runs(both, [0, 1], EPS)
    assert factor == "every time is too large, by 0.001 of it"
    assert clock_of_runs([fast, (1.002 * fine.times, fine)], [0, 1], EPS) == (seen,)
    assert clock_of_runs([fast, (fine.times, fine)], [0], EPS) == (seen,)
    assert seen.startswith("times are off by up to")
    assert clock_of_runs([right], [0], EPS) == ()


@pytest.mark.parametrize(
    ("clock", "text"),
    [
        (lambda t: float(f"{t:.6g}"), "rounded to 6 significant digits"),
        (lambda t: round(t, 4), "rounded to 4 decimals"),
        (lambda t: round(t, 3), "rounded to milliseconds"),
        (lambda t: np.floor(t * 1e3) / 1e3, "cut off to milliseconds"),
        (lambda t: np.round(t * 60) / 60, "rounded to ticks of 1/60 s"),
        (lambda t: t + 1e-6 * np.cos(1e3 * t), ""),
    ],
)
def test_how_a_clock_is_rounded_is_named(clock: Callable[[float], float], text: str) -> None:
    """Caught: decimals taken for significant digits, and any small error for a rounding."""
    every = (SWEEP, Sweep(SWEEP.timestep / 2.0, 80, 8), Sweep(7.0 * SWEEP.timestep, 60, 1))
    runs = [(np.array(list(map(clock, sweep.times))), sweep) for sweep in every]
    *found, seen = clock_of_runs(runs, [0, 1], EPS)
    assert found == [f"the clock is {text}"] * bool(text)
    assert is_fact(seen)
    # of which one run is not rounded
    assert clock_of_runs([*runs, (every[0].times, every[0])], [0, 1], EPS) == (seen,)


def test_a_rounding_of_the_clock_is_the_one_of_most_scenarios() -> None:
    """Times below 10 s have five decimals and six digits, or as many as they have decimals."""
    digits, decimals = (
        f"the clock is rounded to {x}" for x in ("6 significant digits", "5 decimals")
    )
    over = {"one": ([digits, decimals], True), "other": ([digits], True)}
    assert agreed([digits, decimals], over) == [digits]


def test_a_factor_of_the_clock_is_one_of_every_scenario() -> None:
    factor, seen = "every time is too large, by 0.001 of it", "times are off by up to 0.01 s"
    here, other = ((factor, seen), True), ((factor.replace("0.001", "0.002"), seen), True)
    single = (("the times are kept in single precision",), True)
    assert agreed(here[0], {"one": here, "two": here}) == [factor]
    assert agreed(here[0], {"one": here, "two": other}) == [seen]
    assert agreed(here[0], {"one": here, "two": single}) == [seen]


def body() -> Case:
    data = {
        "name": "body",
        "body": {"mass": 2.0, "inertia": [[1.0, 0.1, 0.2], [0.1, 1.6, -0.15], [0.2, -0.15, 2.1]]},
        "initial": {"angular_velocity": [0.8, 2.0, -0.5], "linear_velocity": [1.0, -0.5, 3.0]},
        "run": {"duration": 2.0, "timesteps": [0.02], "sample": 0.1},
    }
    return case_of(scenario(data), [])


@pytest.fixture(scope="module")
def states() -> State:
    return random_states(body(), 40, [1])


MOUNT = np.array([np.cos(0.2), 0.0, 0.0, np.sin(0.2)])
TURN = rotation_matrix(np.array([0.8, 0.1, -0.5, 0.3]) / np.sqrt(0.99))
MISREAD = {
    "feet": ("position", lambda x: 3.28084 * x, "the position is scaled by 3.28084"),
    "shifted": ("position", lambda x: x + np.array([0.25, 0.0, 0.0]), "is off by (0.25, 0, 0)"),
    "down": ("linear_velocity", lambda x: x * np.array([1.0, -1.0, -1.0]), "hold x, -y, -z"),
    "swapped": ("angular_velocity", lambda x: x[:, [1, 0, 2]], "axes of omega are others"),
    "quaternion": ("orientation", lambda q: q[:, [0, 1, 3, 2]], "vector part is another"),
    "turned": ("angular_velocity", lambda w: w @ TURN, "omega is turned by one rotation"),
    "mounted": ("orientation", lambda q: quaternion_product(q, MOUNT + 0.0 * q), "in body axes"),
    "surveyed": ("orientation", lambda q: quaternion_product(MOUNT + 0.0 * q, q), "in world axes"),
}


@pytest.mark.parametrize("name", MISREAD)
def test_what_makes_one_trajectory_out_of_another_is_found_and_undone(
    states: State, name: str
) -> None:
    field, change, phrase = MISREAD[name]
    came = replace(states, **{field: change(getattr(states, field))})
    known = fitted_misreadings(came, states)
    found = [one for one in known if phrase in one.statement and ", and the" not in one.statement]
    assert len(found) == 1
    undone = getattr(found[0].right(came), field)
    assert np.allclose(undone, getattr(states, field), rtol=1e-12, atol=1e-12)


def test_position_and_velocity_may_be_misread_together(states: State) -> None:
    """As of a world with one axis the other way."""
    mirror = np.array([1.0, -1.0, 1.0])
    parts = {"position": states.position * mirror, "linear_velocity": -states.linear_velocity}
    came = replace(states, **parts)
    both = next(one for one in fitted_misreadings(came, states) if ", and the" in one.statement)
    undone = both.right(came)
    assert np.array_equal(undone.position, states.position)
    assert np.allclose(undone.linear_velocity, states.linear_velocity, rtol=1e-12)


def test_one_vector_alone_has_no_addition(states: State) -> None:
    came = replace(states[0], position=states[0].position + 1.0)
    assert not [one for one in fitted_misreadings(came, states[0]) if "is off by" in one.statement]


def test_the_place_among_several_states_is_named(states: State) -> None:
    system = body().system
    true = forward_dynamics(system, states)
    angular = true.angular.copy()
    angular[-1] = angular[-2]
    found = of_forward_dynamics(system, states, Acceleration(angular, true.linear))
    assert place_cause(found).endswith("its omega-dot is that of the one before")
    assert place_cause(of_forward_dynamics(system, states, true)) == ""


def test_a_difference_of_a_few_bounds_has_no_cause(states: State) -> None:
    system = body().system
    true = forward_dynamics(system, states)
    bound = of_forward_dynamics(system, states, true).angular_bound
    few = true.angular + 5.0 * bound[:, None] * np.array([1.0, 0.0, 0.0])
    assert not of_forward_dynamics(system, states, Acceleration(few, true.linear)).clear
    many = true.angular + 1e3 * bound[:, None] * np.array([1.0, 0.0, 0.0])
    assert of_forward_dynamics(system, states, Acceleration(many, true.linear)).clear


def test_two_answers_to_one_request_come_before_any_other_cause() -> None:
    rows = [
        Row("scheme", "omega", "match", 9.0, "1", 1.0, "fail"),
        Row("trajectory", "omega", "repeated", 9.0, "1", 1.0, "fail"),
    ]
    assert "left over from a run before" in again_cause(rows)
    assert again_cause(rows[:1]) == ""


def test_a_cause_of_a_few_scenarios_is_withheld() -> None:
    few = "it is stepped by lie-rk4, though rk4-quaternion is declared"
    other = "omega is held below 3 rad/s"
    assert kind_of(other) == kind_of("omega is held below 47.5 rad/s, at steps of 0.1 s and longer")
    one, two, none = ((few,), True), ((other,), True), ((), True)
    assert agreed((few,), {"one": one, "two": two, "three": two}) == []
    assert agreed((few,), {"one": one, "two": none, "three": none}) == []
    assert agreed((other,), {"one": one, "two": two, "three": two}) == [other]
    assert agreed(("the run is sound until t = 1 s",), {"one": one, "two": two}) != []


def test_a_motion_that_decides_nothing_names_no_cause_of_its_own() -> None:
    """A steady spin is the same by most schemes: what it shows is named where another shows it."""
    one, two = "it is stepped by lie-rk4, though heun is declared", "every step is too long"
    steady = ((one, two), False)
    assert agreed((one, two), {"steady": steady}) == []
    assert agreed((one, two), {"steady": steady, "tumbling": ((two,), True)}) == [two]
    assert agreed((one, two), {"tumbling": ((one, two), True)}) == [one, two]


def test_few_states_sorted_by_chance_have_no_condition(states: State) -> None:
    system, few = body().system, states[:8]
    order = np.argsort(np.linalg.norm(few.angular_velocity, axis=-1))
    sound = np.ones(8, bool)
    sound[order[-3:]] = False
    assert only_where([(system, few, sound)]) == ""


@pytest.mark.parametrize("name", OF_SCHEME)
def test_every_slip_makes_another_scheme(name: str) -> None:
    """By more than rounding, but for those that nothing shows without loads or translation."""
    motion = attitude_motion(body().system)
    q, v = body().initial.orientation, body().initial.angular_velocity
    due = np.concatenate(scheme_named(name).step(motion, q, v, 0.05))
    for text, scheme in slipped(name).items():
        unseen = text.startswith("the position moves") or "loads" in text
        end = np.concatenate(scheme.step(motion, q, v, 0.05))
        assert (np.max(np.abs(end - due)) < 1e-13) == unseen, text


@pytest.mark.parametrize("tau", [0.002, 0.5])
def test_the_time_constant_of_a_filter_is_found_in_its_samples(tau: float) -> None:
    sweep, share = Sweep(0.02, 60, 3), float(np.exp(-0.02 / tau))
    scheme = SCHEMES["rk4-quaternion"]
    every = step_body(scheme, body().system, body().initial, sweep.timestep, sweep.steps, 1)[1]
    logged = every.angular_velocity.copy()
    for k in range(1, len(logged)):
        logged[k] = share * logged[k - 1] + (1.0 - share) * logged[k]
    state = every[sweep.sample_steps]
    came = replace(state, angular_velocity=logged[sweep.sample_steps])
    reported: Any = SimpleNamespace(sweep=sweep, state=came)
    ways = {text: made for text, made, _ in ways_of_steps(reported, every, "angular_velocity", "w")}
    constant = f"a time constant of {written(tau)} s"
    text = f"w is reported through a low-pass of the first order with {constant}"
    assert np.max(np.abs(ways[text] - came.angular_velocity)) < 1e-12


def test_the_constant_of_a_filter_is_one_over_all_runs() -> None:
    text = "omega is reported through a low-pass of the first order with a time constant of {} s"
    assert kind_of(text.format(0.002)) != kind_of(text.format(0.003))


def test_what_stays_as_it_was_given_and_stops_is_not_in_single_precision() -> None:
    """Caught: a steady spin about two axes, put to sleep after a while: few short numbers."""
    w = np.repeat([[0.0, 2.5, -1.0]], 20, axis=0)
    q, none = np.repeat([[0.6, 0.8, 0.0, 0.0]], 20, axis=0), np.zeros((20, 3))
    due = State(q, w * (1.0 + 1e-15 * np.arange(20))[:, None], none, none)
    asleep = State(q, w * (np.arange(20) < 12)[:, None], none, none)
    assert fields_in_single(asleep, due) == []
    faster = (w + 0.1 * np.arange(20)[:, None]).astype(np.float32).astype(float)
    assert fields_in_single(State(q, faster, none, none), due) == ["angular_velocity"]
