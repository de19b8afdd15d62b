"""Samples that are the state of another step than their time's, by their number in every run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from test_over_runs import CASES, STEPS, euler, kept

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.ends.lagging_fields import lagging_fields
from omegadot.diagnosis.stepping.ends.moved_samples import moved_samples
from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.reference_impl.schemes import SCHEMES, Motion
from omegadot.reference_impl.schemes.scheme import CHANNELS
from omegadot.reference_impl.system import Array, System

EULER = "semi-implicit-euler"
BY = SchemeOf(SCHEMES[EULER], "com-world")
PLANS = ((0.02, 1), (0.009, 2), (0.004, 5))
FIRST = "the first sample after the start is the state {}, at the right time"
Shift = Callable[[int], int]


def step(
    system: System, motion: Motion, q: Array, v: Array, h: float, n: int
) -> tuple[Array, Array]:
    return euler(motion, q, v, h, np.zeros(3))


def moved(run: KeptRun, every: int, shift: Shift, but_last: bool = False) -> KeptRun:
    """Each sample as of so many steps more, or all but the last.

    run: of which each step is a sample.
    """
    beyond = 3 * but_last  # steps after the last sample, which samples before it may be of
    places = np.arange(0, len(run.times) - beyond, every)[: STEPS + 1]
    moves = np.array([shift(i) if i else 0 for i in range(len(places))])
    moves[-1] *= not but_last
    numbers = np.maximum(places + moves, 0)
    sweep = replace(run.sweep, steps=int(places[-1]), every=every)
    bounds = {c: values[: len(places) - 1] for c, values in run.bounds.items()}
    state = run.state[np.minimum(numbers, len(run.times) - 1)]
    found = replace(run, sweep=sweep, times=sweep.times, state=state, bounds=bounds)
    return replace(found, fails=not bool(np.all(found.sound(BY))))


def found(
    *shifts: Shift, scheme: str | None = EULER, spoiled: str = "", but_last: bool = False
) -> tuple[str, set[str]]:
    """Of runs whose samples, or all but the last, are moved in one of these ways, in turn."""
    runs = list[KeptRun]()
    for one in CASES:
        for h, every in PLANS:
            whole = kept(one, step, h, 1)
            runs.append(moved(whole, every, shifts[len(runs) % len(shifts)], but_last))
            if one.name == spoiled:
                w = runs[-1].state.angular_velocity.copy()
                w[-1] += 1e-3
                state = replace(runs[-1].state, angular_velocity=w)
                runs[-1] = replace(runs[-1], state=state, fails=True)
    seen = moved_samples(Integrator("own", scheme, dict.fromkeys(CHANNELS, 1)), runs)
    return ("", set()) if seen is None else (seen.statement, set(seen.names))


@pytest.mark.parametrize("scheme", [EULER, None])
@pytest.mark.parametrize(
    ("shift", "text"),
    [
        (lambda i: -(i == 1), FIRST.format("one step early")),
        (lambda i: int(i == 1), FIRST.format("one step further")),
        (
            lambda i: -(i == 4),
            "sample 4 of a run is the state one step early, at the right time",
        ),
        (lambda i: -2 * (i == 1), FIRST.format("two steps early")),
        (
            lambda i: -(i % 2 == 0),
            "of every 2 samples of a run the last is the state one step early, at the right time",
        ),
        (
            lambda i: int(i % 3 == 1),
            "of every 3 samples of a run one is the state one step further, at the right time: "
            "first sample 1",
        ),
    ],
)
def test_samples_of_another_step_are_one_cause(shift: Shift, text: str, scheme: str | None) -> None:
    """Caught: "only the first steps are wrong", and "steps of 0.01 s do not move the body"."""
    assert found(shift, scheme=scheme) == (text, {one.name for one in CASES})


@pytest.mark.parametrize(
    ("shift", "text"),
    [
        (-1, "one step early"),
        (1, "one step further"),
        (-2, "two steps early"),
        (2, "two steps further"),
    ],
)
def test_all_samples_but_the_ends_are_one_cause(shift: int, text: str) -> None:
    """Caught: "the same steps, requested again, give other samples", of another number of them."""
    every_but = f"every sample of a run but the first and the last is the state {text}, at the "
    names = {one.name for one in CASES}
    assert found(lambda i: shift, but_last=True) == (f"{every_but}right time", names)


def test_what_is_not_so_of_every_run_is_not_named() -> None:
    """Caught: one run's samples taken for those of all."""
    assert found(lambda i: 0) == ("", set())
    assert found(lambda i: -(i == 1), lambda i: 0) == ("", set())
    assert found(lambda i: -(i == 1), lambda i: -(i == 2)) == ("", set())
    assert found(lambda i: -(i >= 1)) == ("", set())
    assert found(lambda i: -(i >= 2), but_last=True) == ("", set())
    assert found(lambda i: -1, lambda i: 0, but_last=True) == ("", set())


def test_runs_of_which_the_last_sample_is_not_kept_do_not_show_it_right() -> None:
    """Caught: a first step that is not taken in long runs, taken for samples of another step."""
    cut = list[KeptRun]()
    for one in CASES:
        for h, every in PLANS:
            run = moved(kept(one, step, h, 1), every, lambda i: -1)
            fewer = {c: values[:-1] for c, values in run.bounds.items()}
            state = run.state[:-1]
            cut.append(replace(run, times=run.times[:-1], state=state, bounds=fewer))
    assert moved_samples(Integrator("own", EULER, dict.fromkeys(CHANNELS, 1)), cut) is None


def test_a_scenario_that_is_wrong_elsewhere_is_left_to_other_causes() -> None:
    text, names = found(lambda i: -(i == 1), spoiled="damped")
    assert text == FIRST.format("one step early")
    assert names == {one.name for one in CASES} - {"damped"}


def test_a_first_step_that_is_not_taken_is_no_sample_of_another_step() -> None:
    """Caught: a run that stays one step behind, of which one sample shows it as well."""

    def skip(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        return euler(motion, q, v, h, np.zeros(3)) if n else (q, v)

    runs = [replace(kept(one, skip, h, every), fails=True) for one in CASES for h, every in PLANS]
    assert moved_samples(Integrator("own", EULER, dict.fromkeys(CHANNELS, 1)), runs) is None
    assert all(run.goes_on(BY) for run in runs)  # and its later steps are not too short to act


def test_steps_that_move_nothing_do_not_go_on() -> None:
    runs = [
        kept(one, lambda s, m, q, v, h, n: (q, v), h, every) for one in CASES for h, every in PLANS
    ]
    assert not any(run.goes_on(BY) for run in runs)


def lagging(fields: tuple[str, ...], shift: int, scheme: str | None, first: bool = False) -> str:
    """Of runs of whose samples these fields are of another step: all but the first, or it alone."""
    runs, given = list[KeptRun](), {one.name: one.initial for one in CASES}
    for one in CASES:
        whole = kept(one, step, 0.02, 1)
        right = moved(whole, 2, lambda i: 0)
        at = right.sweep.sample_steps
        places = np.minimum(at + shift * ((at == 0) == first), len(whole.times) - 1)
        state = replace(
            right.state, **{name: getattr(whole.state, name)[places] for name in fields}
        )
        runs.append(replace(right, state=state, fails=True))
    seen = lagging_fields(Integrator("own", scheme, dict.fromkeys(CHANNELS, 1)), runs, given)
    return "" if seen is None else seen.statement


@pytest.mark.parametrize("scheme", [EULER, None])
@pytest.mark.parametrize(
    ("fields", "shift", "text"),
    [
        (
            ("orientation", "position"),
            -1,
            "the attitude and position of every sample after the start are of the step before",
        ),
        (
            ("angular_velocity",),
            1,
            "the omega of every sample after the start is of the step after",
        ),
        (("orientation",), 0, ""),
        (("orientation",), -2, ""),
    ],
)
def test_fields_that_lag_in_every_sample_are_named(
    fields: tuple[str, ...], shift: int, text: str, scheme: str | None
) -> None:
    """Caught: "the attitude does not move in the first step", as such a sample makes it look."""
    found = lagging(fields, shift, scheme).replace("is that of", "is of").replace("those of", "of")
    assert found == (f"{text} its time" if text else "")


@pytest.mark.parametrize("scheme", [EULER, None])
def test_fields_of_the_first_sample_that_are_of_after_the_first_step_are_named(
    scheme: str | None,
) -> None:
    """Caught: "runs begin at other states", though they go on from the one that is given."""
    found = lagging(("angular_velocity", "linear_velocity"), 1, scheme, first=True)
    assert found == "the omega of the first sample, at the start, is that of after the first step"
