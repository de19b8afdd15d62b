"""Samples that all hold one, and runs that begin where the one before ended."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from test_short_steps import SCHEME, own_run

from omegadot.diagnosis.reported.one_of_all import one_of_all
from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.reported.run_causes import begin_apart
from omegadot.harness.drive import CaseResult
from omegadot.reference_impl.system import State
from omegadot.workers.harness_end.process import Answer

FIELDS = tuple(State.__dataclass_fields__)


@pytest.fixture(scope="module")
def sound() -> ReportedRun:
    return own_run("heavy-top")


def result_of(*runs: tuple[float, State]) -> CaseResult:
    """Runs of so long steps, one after the other."""
    times = [np.arange(len(state.position), dtype=float) for _, state in runs]
    answers = [
        Answer("ok", result={"time": t, "state": vars(state)})
        for t, (_, state) in zip(times, runs, strict=True)
    ]
    steps = [step for step, _ in runs]
    return CaseResult(runs={(SCHEME, h): a for h, a in zip(steps, answers, strict=True)})


def held(run: ReportedRun, sample: int, names: tuple[str, ...]) -> ReportedRun:
    state = run.state
    one = {n: np.broadcast_to(v[sample], v.shape) for n, v in vars(state).items() if n in names}
    return replace(run, state=replace(state, **one))


@pytest.mark.parametrize(
    ("names", "what"),
    [
        (("angular_velocity",), "omega"),
        (("orientation",), "the attitude"),
        (FIELDS, "the state"),
    ],
)
def test_a_buffer_that_is_not_copied_is_named(
    sound: ReportedRun, names: tuple[str, ...], what: str
) -> None:
    """Caught: "runs begin at other states", of which one were left over from a run before."""
    texts = {
        -1: f"{what} is the same at every sample of a run: that of its last sample, as of one "
        "buffer that is not copied",
        0: f"{what} is the same at every sample of a run: that of its first sample"
        if names != FIELDS
        else "",  # a body that does not move has causes of its own
        4: "",  # of neither
    }
    for sample, text in texts.items():
        run = held(sound, sample, names)
        result = result_of((sound.sweep.timestep, run.state))
        assert one_of_all(run.until(6), result) == text


def test_a_quantity_that_is_right_is_not_held(sound: ReportedRun) -> None:
    """Of a spin that stays as it is omega is the same at every sample."""
    still = own_run("principal-spin-major")
    for run in (sound, still):
        assert one_of_all(run, result_of((run.sweep.timestep, run.state))) == ""


def test_a_run_that_begins_where_another_ended_is_left_over(sound: ReportedRun) -> None:
    """Caught: runs that begin apart by anything, such as noise, as left over."""
    left = sound.stepped(initial=sound.state[-1])
    h = sound.sweep.timestep
    assert begin_apart(sound, result_of((h, sound.state), (h / 2.0, left)))
    one_on = sound.stepped(initial=sound.stepped_on(sound.state[-1:], 1)[0])
    assert begin_apart(sound, result_of((2.0 * h, sound.state), (h, one_on)))
    w = sound.state.angular_velocity
    noisy = replace(sound.state, angular_velocity=w + 1e-6)
    seen = begin_apart(sound, result_of((h, sound.state), (h / 2.0, noisy)))
    assert seen == "runs begin at other states than the one given, and at different ones"
