"""A quantity that is summed up over the steps is named, and no sound or other one is."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from test_short_steps import own_run

from omegadot.diagnosis.reported.field_causes import field_causes
from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.system import Array


@pytest.fixture(scope="module")
def sound() -> ReportedRun:
    return own_run("heavy-top").until(12)


def summed(run: ReportedRun, first: Array, rate: Array, share: float) -> Array:
    """All steps, of so much of the rate at the end of each, by a loop of its own."""
    values = [first]
    for start, end in pairwise(rate):
        values.append(values[-1] + run.sweep.timestep * ((1.0 - share) * start + share * end))
    return np.stack(values)


@pytest.mark.parametrize(
    ("share", "which"),
    [
        (1.0, "that of the step's end"),
        (0.0, "that of the step's start"),
        (0.5, "the mean of those at its two ends"),
    ],
)
def test_a_place_that_is_integrated_is_named(sound: ReportedRun, share: float, which: str) -> None:
    """Caught: "the position alone is wrong in the run", and no more."""
    every, numbers = sound.stepped(every_step=True), sound.sweep.sample_steps
    place = summed(sound, every.position[0], every.linear_velocity, share)
    rate = forward_dynamics(sound.case.system, every).linear
    velocity = summed(sound, every.linear_velocity[0], rate, share)
    by = f"h times {which} in each step"
    of = "of a pivoted body is summed up from"

    def causes(**wrong: Array) -> list[str]:
        return field_causes(replace(sound, state=replace(sound.state, **wrong)))

    assert causes(position=place[numbers]) == [
        f"the position {of} the velocity, {by}: it leaves the pivot"
    ]
    assert causes(linear_velocity=velocity[numbers]) == [
        f"the velocity {of} its rate, {by}: it is no longer omega x r"
    ]
    both = summed(sound, every.position[0], velocity, share)
    assert causes(position=both[numbers], linear_velocity=velocity[numbers]) == [
        f"the velocity {of} its rate, {by}, and the position from that velocity, {by}: "
        "it leaves the pivot"
    ]


def test_a_place_that_is_off_otherwise_is_no_sum(sound: ReportedRun) -> None:
    assert field_causes(sound) == []
    time = sound.time[:, None]
    state = replace(sound.state, position=sound.state.position * (1.0 + 1e-3 * time))
    assert not any("summed" in text for text in field_causes(replace(sound, state=state)))
