"""The search for the largest step, on errors that are known as functions of the step."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from omegadot.commands.choose.search import EDGE, Edge, Search, Trials
from omegadot.commands.choose.trial import Measured, Trial

LIMITS = {"attitude": 1.0}
FEWEST, MOST = 10, 1_000_000


def search(error: Callable[[float], float], start: int = 1000, declared: float = 2.0,
           most: int = MOST) -> tuple[Edge, Trials]:  # fmt: skip
    """Seek over a horizon of 1 s for an error of at most 1."""

    def evaluate(steps: int) -> Trial:
        assert FEWEST <= steps <= max(most, start)
        assert steps not in trials, "a run is never made twice"
        measured = {"attitude": Measured(error(1.0 / steps), 0.0)}
        return Trial(steps, 1.0 / steps, measured, 1e-6, steps + 1)

    trials: Trials = {}
    trials[start] = evaluate(start)
    edge = Search(trials, evaluate, LIMITS, FEWEST, lambda: most, declared).confirmed()
    return edge, trials


@given(order=st.floats(0.9, 6.0), edge=st.floats(20.0, 1e5), declared=st.floats(1.0, 4.0))
@settings(derandomize=True, max_examples=60, deadline=None)
def test_the_edge_of_a_power_law_is_found(order: float, edge: float, declared: float) -> None:
    found, trials = search(lambda h: (h * edge) ** order, declared=declared)
    assert found.passing is not None
    assert found.failing is not None
    assert found.failing.steps < edge <= found.passing.steps
    assert found.passing.steps <= max(EDGE * found.failing.steps, found.failing.steps + 1)
    assert len(trials) <= 16


@given(edge=st.floats(50.0, 1e5), depth=st.floats(0.0, 0.9), waves=st.floats(1.0, 30.0))
@settings(derandomize=True, max_examples=60, deadline=None)
def test_a_wavy_error_is_judged_by_runs_alone(edge: float, depth: float, waves: float) -> None:
    """What is guaranteed: it and every smaller step tried pass, the next larger one fails."""

    def error(h: float) -> float:
        return (h * edge) ** 2 * (1.0 + depth * math.sin(waves * math.log(h)))

    found, trials = search(error)
    assert found.passing is not None
    assert found.failing is not None
    assert all(t.passes(LIMITS) for t in trials.values() if t.steps >= found.passing.steps)
    assert not found.failing.passes(LIMITS)
    assert found.failing.steps == max(n for n in trials if n < found.passing.steps)
    assert found.passing.steps <= max(EDGE * found.failing.steps, found.failing.steps + 1)


def test_a_dip_is_not_taken_for_the_edge() -> None:
    """The error crosses zero at a step beyond the edge: that step passes, and is not proposed."""
    found, trials = search(lambda h: abs((100 * h) ** 2 * 4.0 * (h * 60.0 - 1.0)), start=60)
    assert trials[60].passes(LIMITS)
    assert found.passing is not None
    assert found.passing.steps > 60
    assert found.again is not None
    assert found.again.steps <= 60


def test_steps_that_blow_up_or_saturate_are_left_behind() -> None:
    found, _ = search(lambda h: math.inf if h > 1e-3 else 3e4 * min(1.0, (h * 3000) ** 4), start=20)
    assert found.passing is not None
    assert found.passing.steps == pytest.approx(3000 * (3e4) ** 0.25, rel=EDGE - 1.0)


def test_an_exact_integrator_is_taken_to_the_fewest_steps() -> None:
    found, _ = search(lambda h: 1e-12)
    assert found.passing is not None
    assert found.passing.steps == FEWEST
    assert found.failing is None


def test_what_is_out_of_reach_is_tried_at_the_finest_step_and_no_further() -> None:
    found, trials = search(lambda h: 1e9 * h, most=4096)
    assert found.passing is None
    assert found.failing is not None
    assert found.failing.steps == 4096 == max(trials)
    assert len(trials) <= 4


def test_what_the_truth_leaves_open_counts_against_a_run() -> None:
    trial = Trial(10, 0.1, {"attitude": Measured(0.9, 0.2)}, 1e-6, 11)
    assert not trial.passes(LIMITS)
    assert trial.missed(LIMITS) == ["attitude"]


def test_not_a_number_never_passes() -> None:
    trial = Trial(10, 0.1, {"attitude": Measured(math.nan, 0.0)}, 1e-6, 11)
    assert not trial.passes(LIMITS)
    assert trial.ratio(LIMITS) == math.inf
    assert trial.missed(LIMITS) == ["attitude"]


def test_other_limits_are_sought_from_the_runs_that_are_there() -> None:
    _, trials = search(lambda h: (200 * h) ** 4)
    made: list[int] = []

    def evaluate(steps: int) -> Trial:
        made.append(steps)
        measured = {"attitude": Measured((200 / steps) ** 4, 0.0)}
        return Trial(steps, 1.0 / steps, measured, 1e-6, steps + 1)

    tighter = Search(trials, evaluate, {"attitude": 0.5}, FEWEST, lambda: MOST, 4.0).largest_step()
    assert tighter.passing is not None
    assert tighter.passing.steps == pytest.approx(200 * 2**0.25, rel=EDGE - 1.0)
    assert len(made) <= 3
