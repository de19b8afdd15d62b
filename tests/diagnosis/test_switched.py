"""Runs that go on by another scheme: from which step, or from which time on, and of which."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pytest
from wrong_equations import PIVOT, case

from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.stepping.slips.scheme_by_length import scheme_by_length
from omegadot.diagnosis.stepping.slips.switched import switched
from omegadot.gates.case import Case, Sweep
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array

BY = SchemeOf(SCHEMES["implicit-midpoint"], "com-world")
OTHER = "semi-implicit-euler"
CASES = (
    case("free", {}),
    case("held", {"pivot": PIVOT, "gravity": [0.0, 0.0, -9.81]}),
    case("damped", {"damping": 1.0}),
)
# s, so that no number of steps, and no time, is one share of all runs
DURATIONS = {"free": 0.96, "held": 1.6, "damped": 1.28}
LENGTHS, NEVER = (0.02, 0.01), 1000


def kept(one: Case, h: float, every: int, first: int, other: str = OTHER) -> KeptRun:
    """A run of which so many steps are the declared scheme's, and the rest another's."""
    taken = [0]

    def step(motion: object, q: Array, v: Array, dt: float | Array) -> tuple[Array, Array]:
        taken[0] += 1
        scheme = BY.scheme if taken[0] <= first else SCHEMES[other]
        return scheme.step(motion, q, v, dt)  # type: ignore[arg-type]

    scheme, steps = replace(BY.scheme, step=step), round(DURATIONS[one.name] / h)
    state = step_body(scheme, one.system, one.initial, h, steps, every)[1]
    sweep = Sweep(h, steps, every)
    sizes = {"omega": 1e-11, "attitude": 1e-11, "velocity": 1e-11, "position": 1e-11}
    bounds = {c: np.full(len(sweep.times) - 1, size) for c, size in sizes.items()}
    return KeptRun(one.name, one.system, sweep, sweep.times, state, bounds, first < steps)


def named(
    first: Callable[[float], int], every: Sequence[int] = (1, 4), lengths: Sequence[float] = LENGTHS
) -> list[str]:
    runs = [kept(one, h, n, first(h)) for one in CASES for h in lengths for n in every]
    return switched(BY, runs)


def test_a_step_from_which_on_steps_are_another_schemes_is_named() -> None:
    """Caught: how far each run is sound, which the motion decides as well."""
    (text,) = named(lambda _: 30)
    assert text.startswith(f"from step 31 on, steps are those of {OTHER}")


def test_within_an_interval_the_step_is_known_by_both_schemes() -> None:
    """Caught: any step between two samples."""
    (text,) = named(lambda _: 30, every=(8,))
    assert text.startswith(f"from step 31 on, steps are those of {OTHER}")


def test_a_time_from_which_on_they_are_is_named() -> None:
    (text,) = named(lambda h: round(0.6 / h))
    low, high = (float(x) for x in text.removeprefix("from a time between ").split()[0:3:2])
    assert low <= 0.6 <= high
    assert f" s on, steps are those of {OTHER}" in text


@pytest.mark.parametrize(
    "first",
    [lambda h: 30 if h > 0.015 else 40, lambda _: 0, lambda _: NEVER],
    ids=["neither", "from the start", "never"],
)
def test_runs_that_do_not_agree_show_nothing(first: Callable[[float], int]) -> None:
    """Caught: what one run shows, taken for what all do."""
    assert named(first) == []


def test_of_one_length_of_step_a_number_is_a_time_as_well() -> None:
    assert named(lambda _: 30, lengths=(0.02,)) == []


def test_a_share_of_each_run_is_named_as_one() -> None:
    """Caught: a number of steps, or a time, that some runs contradict."""
    runs = [
        kept(one, h, n, round(0.5 * DURATIONS[one.name] / h))
        for one in CASES
        for h in LENGTHS
        for n in (1, 4)
    ]
    (text,) = switched(BY, runs)
    assert text.startswith("from a share of each run between ")
    assert " and 50 % on, steps are those of " in text


def by_length(first: Callable[[float], int]) -> list[str]:
    runs = [kept(one, h, 1, first(h)) for one in CASES for h in (0.04, 0.02, 0.01)]
    return scheme_by_length(BY, runs)


@pytest.mark.parametrize(
    ("first", "way"),
    [
        (lambda h: 0 if h > 0.015 else NEVER, "longer than a limit between 0.01 and 0.02 s"),
        (lambda h: 0 if h < 0.015 else NEVER, "shorter than a limit between 0.01 and 0.02 s"),
    ],
)
def test_steps_beyond_a_length_that_are_another_schemes_are_named(
    first: Callable[[float], int], way: str
) -> None:
    """Caught: that it is stepped by another scheme, where shorter steps are the declared one's."""
    assert by_length(first) == [f"steps {way} are by {OTHER}, not by {BY.scheme.name}"]


def test_runs_that_no_length_sorts_are_not_said_to_be_by_length() -> None:
    assert by_length(lambda h: 0) == []
    assert by_length(lambda h: NEVER) == []
    assert by_length(lambda h: 0 if h == 0.02 else NEVER) == []
    assert by_length(lambda h: 3 if h > 0.015 else NEVER) == []
