"""Steps that are too short to act, samples that come twice, and what is zero but for rounding."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from in_process import builtin, declared, truth_of

from omegadot.diagnosis.reported.late import late
from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.reported.run_causes import last_repeated
from omegadot.diagnosis.stepping.vanishing.kinematics import least_step
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import vanishing_steps
from omegadot.diagnosis.wording.laws import law_of
from omegadot.gates.case import Case
from omegadot.gates.states.equation import random_states
from omegadot.gates.steps.probe import DOUBLE, Probe
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import exp_quaternion, quaternion_product, rotate
from omegadot.reference_impl.system import State
from omegadot.written import written

SCHEME = "semi-implicit-euler"


def own_run(name: str) -> ReportedRun:
    """The reference's own run of a built-in scenario."""
    case = builtin(name)
    truth, integrator = truth_of(case, (SCHEME,)), declared(SCHEME, SCHEME)
    sweep = case.sweeps_of(integrator)[0]
    own = truth.companion(integrator, sweep)
    assert own is not None
    return ReportedRun(
        case, truth, integrator, sweep, sweep.times, own.state, own.state, own.growth
    )


def one_step(case: Case, probe: Probe) -> State:
    """By the explicit Euler method, (m, k, ...); a pivoted body's place is left out."""
    start = State(*(values[:, None] for values in vars(probe.states).values()))
    rates, h = forward_dynamics(case.system, probe.states), probe.timesteps[..., None]
    w, v = start.angular_velocity, start.linear_velocity
    turned = quaternion_product(start.orientation, exp_quaternion(h * w))
    return State(
        turned,
        w + h * rates.angular[:, None],
        start.position + h * v,
        v + h * rates.linear[:, None],
    )


def test_steps_below_a_limit_are_one_cause_of_all_scenarios() -> None:
    """Caught: another length on each scenario, and one of a step that moves the body."""
    bounds, limit = list[tuple[float, float]](), 1e-3
    for name in ("t-handle", "heavy-top", "free-bar"):
        case = builtin(name)
        states = random_states(case, 6, [1])
        w = np.linalg.norm(states.angular_velocity, axis=-1)
        steps = (2.0**-7 / w)[:, None] / 2.0 ** np.arange(DOUBLE.count)
        probe = Probe(states, steps)
        ends = one_step(case, probe)
        moves = steps[..., None] >= limit
        pairs = zip(vars(states).values(), vars(ends).values(), strict=True)
        # what setting and reading a state rounds is nothing that a step does
        kept = State(*(np.where(moves, end, start[:, None] * (1 + 1e-16)) for start, end in pairs))
        bounds.append(vanishing_steps(case.system, probe, kept).stays_below)
        assert bounds[-1][0] < limit <= bounds[-1][1]
    text = least_step(bounds)
    low, high = max(one for one, _ in bounds), min(one for _, one in bounds)
    assert text.startswith("steps below a limit between ")
    assert low < limit <= high
    assert least_step([*bounds, (2.0 * high, np.inf)]) == ""
    assert least_step([(0.0, high)]) == ""


def test_a_last_sample_that_comes_twice_is_named() -> None:
    """Caught: "the run is wrong once". A body that sleeps repeats more than the last."""
    run = own_run("heavy-top")
    sweep, own = run.sweep, run.own
    assert last_repeated(run) == ""
    for repeated, text in (
        ([-2], "the last sample is the one before, reported twice"),
        ([-3, -3], ""),
    ):
        count = len(sweep.times) - len(repeated)
        order = np.concatenate((np.arange(count), len(sweep.times) + np.array(repeated)))
        assert last_repeated(replace(run, state=own[order])) == text


def test_components_that_are_zero_but_for_rounding_have_a_limit() -> None:
    """Caught: levers read back from places, where what is zero comes as 1e-18."""
    pairs = [
        (np.array([0.02, 0.004, 0.0007]), np.array([0.02, 8e-19, -2e-18])),
        (np.array([0.3, 0.001, 0.2]), np.array([0.3, 0.0, 0.2])),
        (np.array([0.006, 0.04, 0.03]), np.array([0.006, 0.04, 0.03])),
    ]
    text = "each component of the lever is taken for zero below a limit between 0.004 and 0.006 m"
    assert law_of(pairs, "the lever", "m") == text


def test_a_quantity_in_a_few_decimals_is_named() -> None:
    """Caught: "the first step changes the linear velocity by some 1e-7 m/s"."""
    case = builtin("free-bar")
    states = random_states(case, 6, [1])
    w = np.linalg.norm(states.angular_velocity, axis=-1)
    probe = Probe(states, (2.0**-7 / w)[:, None] / 2.0 ** np.arange(DOUBLE.count))
    ends = one_step(case, probe)
    assert vanishing_steps(case.system, probe, ends).rounded == ""
    velocity = np.round(ends.linear_velocity * 1e6) * 1e-6  # off by a last digit
    found = vanishing_steps(case.system, probe, replace(ends, linear_velocity=velocity))
    assert found.rounded == "the linear velocity is rounded to 6 decimals in each step"


def test_samples_that_are_late_from_some_time_on_are_named() -> None:
    """Caught: "the run is wrong once", where a buffer has wrapped."""
    run = own_run("heavy-top")
    sweep = run.sweep
    every, numbers = run.stepped(every_step=True), sweep.sample_steps
    since = 7
    shifted = np.where(np.arange(len(numbers)) < since, numbers, numbers - 1)
    found = late(replace(run, state=every[shifted]))
    assert found == [
        f"from t = {written(sweep.times[since], 4)} s on, every sample is the state one step before"
    ]
    assert late(run) == []


def test_the_velocity_of_a_pivoted_body_by_an_omega_of_the_step_before_is_named() -> None:
    """Caught: "the linear acceleration has r x omega-dot in it", of a report that is late."""
    case = builtin("heavy-top")
    arm = np.asarray(lever(case.system), dtype=float)
    states = random_states(case, 6, [1])
    w = np.linalg.norm(states.angular_velocity, axis=-1)
    probe = Probe(states, (2.0**-7 / w)[:, None] / 2.0 ** np.arange(DOUBLE.count))
    ends = one_step(case, probe)
    start = State(*(values[:, None] for values in vars(states).values()))
    for what, q, omega in (
        ("", ends.orientation, ends.angular_velocity),
        ("omega", ends.orientation, start.angular_velocity),
        ("attitude", start.orientation, ends.angular_velocity),
        ("omega and attitude", start.orientation, start.angular_velocity),
    ):
        velocity = rotate(q, cross(omega, arm)) + 0.0 * ends.linear_velocity
        placed = replace(ends, linear_velocity=velocity, position=rotate(ends.orientation, arm))
        assert vanishing_steps(case.system, probe, placed).late_velocity == what


def test_what_a_step_returns_in_single_precision_is_seen() -> None:
    """Caught: "none is known" where omega is constant, and a run shows no rounding of it."""
    case = builtin("free-bar")
    states = random_states(case, 6, [1])
    w = np.linalg.norm(states.angular_velocity, axis=-1)
    probe = Probe(states, (2.0**-7 / w)[:, None] / 2.0 ** np.arange(DOUBLE.count))
    ends = one_step(case, probe)
    assert vanishing_steps(case.system, probe, ends).single == ""
    single = {k: v.astype(np.float32).astype(float) for k, v in vars(ends).items()}
    omega = replace(ends, angular_velocity=single["angular_velocity"])
    assert vanishing_steps(case.system, probe, omega).single == "omega is"
    assert vanishing_steps(case.system, probe, State(**single)).single == "the state is"
    place = replace(ends, position=single["position"])
    assert vanishing_steps(case.system, probe, place).single == "the position is"
