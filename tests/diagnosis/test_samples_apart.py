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
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import normalize


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
    assert "packed" not in precision_reported(replace(sound, state=state))


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
