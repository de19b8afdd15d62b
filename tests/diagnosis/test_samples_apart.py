"""Samples that are of another step, in few bits, or moved on in each step, in sound runs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from test_short_steps import own_run

from omegadot.diagnosis.reported.field_causes import field_causes
from omegadot.diagnosis.reported.late import late
from omegadot.diagnosis.reported.precision import precision_reported
from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.reported.sample_causes import last_sample
from omegadot.diagnosis.wording.kinds import is_fact
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import normalize, turn_in_body


@pytest.fixture(scope="module")
def sound() -> ReportedRun:
    return own_run("heavy-top").until(12)


@pytest.mark.parametrize("most", [32767, 128, 2**20])
@pytest.mark.parametrize("unit", [True, False])
def test_attitudes_packed_in_integers_are_named(sound: ReportedRun, most: int, unit: bool) -> None:
    """Caught: "the run does not begin at the state it is given", and steps that remember."""
    q = np.round(most * sound.state.orientation) / most
    state = replace(sound.state, orientation=normalize(q) if unit else q)
    bits = round(np.log2(most)) + 1
    found = precision_reported(replace(sound, state=state))
    if unit or most % 2:
        assert f"packed in integers of {bits} bits" in found
    else:
        assert found == f"the attitude is rounded to multiples of 2^{1 - bits} in the run"


def test_attitudes_in_full_are_not_packed(sound: ReportedRun) -> None:
    assert precision_reported(sound) == ""
    single = normalize(sound.state.orientation.astype(np.float32).astype(float))
    state = replace(sound.state, orientation=single)
    found = precision_reported(replace(sound, state=state))
    assert found == "the attitude is reported in single precision, and kept in double"
    further = turn_in_body(sound.state.orientation, np.ones((len(single), 3)), 1e-4)
    kept = normalize(further.astype(np.float32).astype(float))
    found = precision_reported(replace(sound, state=replace(state, orientation=kept)))
    assert found == "the attitude is kept in single precision"


@pytest.mark.parametrize("field", ["position", "linear_velocity"])
def test_places_in_single_precision_are_named(sound: ReportedRun, field: str) -> None:
    """Caught: "the run does not begin at the state it is given", of a log in single precision."""
    single = getattr(sound.state, field).astype(np.float32).astype(float)
    what = field.replace("_", " ")
    found = precision_reported(replace(sound, state=replace(sound.state, **{field: single})))
    assert found == f"the {what} is reported in single precision"
    further = (1.0 + 1e-5) * single
    kept = replace(sound.state, **{field: further.astype(np.float32).astype(float)})
    found = precision_reported(replace(sound, state=kept))
    assert found == f"the {what} is kept in single precision"


@pytest.mark.parametrize(("shift", "when"), [(1, "after"), (-1, "before")])
def test_some_samples_of_another_step_are_named(sound: ReportedRun, shift: int, when: str) -> None:
    """Caught: "the run is wrong once", of a clock that is summed up and compared with n h."""
    longer = replace(sound, sweep=replace(sound.sweep, steps=sound.sweep.steps + 1))
    every, numbers = longer.stepped(every_step=True), sound.sweep.sample_steps.copy()
    first = f"some samples, the first at t = {sound.time[3]:g} s, are the state one step {when}"
    numbers[[3, 7, -1]] += shift
    assert late(replace(sound, state=every[numbers])) == [first]
    numbers[5] += 2 * shift  # which is of no neighbouring step
    assert late(replace(sound, state=every[numbers])) == []
    assert late(sound) == []


def test_a_body_that_does_not_move_has_no_shorter_intervals(sound: ReportedRun) -> None:
    """Caught: "each interval is one step shorter", of intervals of one step, in a body at rest."""
    every = replace(sound.sweep, every=1, steps=len(sound.time) - 1)
    stays = sound.state[np.zeros(len(sound.time), dtype=int)]
    assert late(replace(sound, sweep=every, state=stays)) == []


def test_a_place_that_each_step_moves_further_is_named() -> None:
    """Caught: "the position alone is wrong in the run", of ``x + h v + h^2 g`` for half of it."""
    falling = own_run("gazebo-complex-box")
    h, numbers = falling.sweep.timestep, falling.sweep.sample_steps
    rate = forward_dynamics(falling.case.system, falling.stepped(every_step=True)).linear
    moved = np.cumsum(np.concatenate((0 * rate[:1], 0.5 * h**2 * rate[:-1])), axis=0)[numbers]
    state = replace(falling.state, position=falling.state.position + moved)
    named = "each step moves the position by 0.5 h^2 times the linear acceleration in addition"
    assert named in field_causes(replace(falling, state=state))
    other = falling.state.position * (1.0 + 1e-3 * falling.time[:, None] ** 3)
    state = replace(falling.state, position=other)
    assert not any("each step moves" in t for t in field_causes(replace(falling, state=state)))


@pytest.mark.parametrize("samples", [3, 6, 20])
def test_omega_kept_in_single_precision_is_not_said_to_be_reported_so(
    sound: ReportedRun, samples: int
) -> None:
    """Caught: omega kept so for a few steps, in which it is off by no more than a last digit."""
    few = sound.until(samples)
    single = few.own.angular_velocity.astype(np.float32).astype(float)
    logged = replace(few, state=replace(few.own, angular_velocity=single))
    assert precision_reported(logged) == "omega is reported in single precision, and kept in double"
    turned = turn_in_body(
        few.own.orientation, np.full(3, 1e-9), 1.0
    )  # as omega's rounding makes it
    kept = replace(few, state=replace(logged.state, orientation=turned))
    assert precision_reported(kept) == "omega is kept in single precision"


def test_what_is_wrong_in_the_last_sample_alone_is_named_with_it() -> None:
    """Caught: "omega alone is wrong in the run", and a difference quotient, of one number."""
    run = own_run("damped-tumble")
    omega = run.own.angular_velocity.copy()
    omega[-1] *= 1.0 + 1e-7
    wrong = replace(run, state=replace(run.own, angular_velocity=omega))
    assert last_sample(wrong) == "omega of the last sample alone is wrong, by up to 1e-7 of it"
    assert is_fact(last_sample(wrong))
    omega[-2] *= 1.0 + 1e-7
    assert last_sample(replace(run, state=replace(run.own, angular_velocity=omega))) == ""
    assert last_sample(run) == last_sample(wrong.until(20)) == ""


def test_no_way_is_named_by_which_the_right_values_are_as_near() -> None:
    """Caught: a difference quotient over a tiny step, whose rounding hides what is wrong."""
    run = own_run("t-handle")
    tiny = replace(run, sweep=replace(run.sweep, timestep=1e-9, steps=10, every=1))
    times = tiny.sweep.times
    tiny = replace(tiny, time=times, growth=run.growth[: len(times)])
    own = tiny.stepped()
    omega = own.angular_velocity.copy()
    omega[-1] *= 1.0 + 1e-9
    came = replace(own, angular_velocity=omega)
    assert field_causes(replace(tiny, own=own, state=came)) == []


def test_one_number_again_and_again_is_no_grain() -> None:
    """Caught: "omega is rounded to multiples of 2^-22", of single numbers of a constant omega."""
    run = own_run("principal-spin-major")
    came = np.full_like(run.own.angular_velocity, 5.0 * 2.0**-22 + 0.75)
    assert precision_reported(replace(run, state=replace(run.own, angular_velocity=came))) == ""
