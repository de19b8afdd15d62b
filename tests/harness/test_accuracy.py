"""Error-controlled integrators: what follows its accuracy passes, and what does not is caught.

What these tests catch: a judgement that takes a tolerance for a step; one that takes the error of a
tolerance, or of steps that end at samples, for a fault; one that lets a floor pass because coarse
accuracies hide it; an accuracy that never reaches the engine.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import product

import numpy as np
import pytest
from harness.error_controlled import (
    FAULTY,
    MANY,
    SOUND,
    EndsAtSamples,
    EndsInNothing,
    ErrorControlled,
    Fehlberg,
    Fixed,
    FixedAndDrags,
    FixedAndRunsFast,
    FixedTight,
    LaterRunsDrag,
    Multistep,
)

from omegadot.adapters.exact.adapter import ExactAdapter
from omegadot.adapters.protocol import Adapter
from omegadot.gates.case import ACCURACIES, Case
from omegadot.gates.states.equation import EvaluationStates, evaluation_states_of
from omegadot.gates.truth import Truth
from omegadot.harness.arguments import case_of
from omegadot.harness.in_process import driver_of
from omegadot.harness.judging.judged_run import JudgedRun
from omegadot.harness.judging.refine import MOST_HALVINGS, Refinements, refine
from omegadot.harness.judging.runs import judge_case
from omegadot.harness.random_cases import random_case
from omegadot.harness.requests.repeats import request_again
from omegadot.harness.requests.step_probes import probe_steps
from omegadot.harness.requests.truth_requests import case_truth
from omegadot.scenarios import load_builtin

pytestmark = pytest.mark.no_cover  # its lines are covered by others

SEED = 7
NAMES = ("t-handle", "heavy-top", "random-1", "random-2")


@cache
def prepared(name: str) -> tuple[Case, Truth, EvaluationStates]:
    kind, _, number = name.partition("-")
    case = random_case(SEED, int(number)) if kind == "random" else case_of(load_builtin(name), ())
    truth = case_truth(driver_of("exact", ExactAdapter()), case)
    assert isinstance(truth, Truth), truth
    return case, truth, evaluation_states_of(case, truth, SEED)


def judged(name: str, adapter: Adapter) -> list[JudgedRun]:
    """The runs of an engine on a case, with the finer ones that they ask for."""
    case, truth, states = prepared(name)
    driver = driver_of("engine", adapter)
    result = driver.evaluate_equations(case, states)
    result.runs.update(driver.run_all(case, lambda: None))
    probe_steps(driver, case, states, result)
    finer: Refinements = {}
    with np.errstate(all="ignore"):
        runs = judge_case(truth, case, result, finer)
        for _ in range(MOST_HALVINGS):
            if not refine(driver, case, runs, finer.setdefault("engine", {})):
                break
            runs = judge_case(truth, case, result, finer["engine"])
    assert all(run.outcome == "ok" for run in runs), [run.reason for run in runs]
    return runs


def failures(runs: list[JudgedRun]) -> list[str]:
    return [f"{r.gate} {r.channel} {r.note}" for run in runs for r in run.rows
            if r.verdict == "fail"]  # fmt: skip


@pytest.mark.parametrize(
    ("engine", "name"),
    [
        *product(SOUND, ("random-1", "random-2")),
        (ErrorControlled, "t-handle"),
        (EndsAtSamples, "t-handle"),
        (Multistep, "heavy-top"),
        *product((Fehlberg,), ("driven-world", "driven-body", "principal-spin-middle")),
    ],
)
def test_what_follows_its_accuracy_passes(engine: type[ErrorControlled], name: str) -> None:
    runs = judged(name, engine())
    assert failures(runs) == []
    wanted = [max(accuracy, engine.FINEST) for accuracy in ACCURACIES]
    assert [run.sweep.accuracy for run in runs] == list(dict.fromkeys(wanted))
    verdicts = {row.verdict for run in runs for row in run.rows if row.metric == "error_max"}
    assert "pass" in verdicts


@pytest.mark.parametrize("engine", FAULTY)
def test_what_does_not_is_caught(engine: type[ErrorControlled]) -> None:
    assert any(failures(judged(name, engine())) for name in ("random-2", "t-handle"))


@pytest.mark.parametrize(("engine", "name"), [(Fixed, "t-handle"), (FixedTight, "random-2")])
def test_a_tolerance_that_cannot_be_set_is_no_fault(engine: type[Fixed], name: str) -> None:
    runs = judged(name, engine())
    assert failures(runs) == []
    assert {run.integrator.knob for run in runs} == {"fixed-accuracy"}
    assert [run.sweep for run in runs] == list(prepared(name)[0].sweeps)
    errors = [
        r for run in runs for r in run.rows if r.metric == "error_max" and r.verdict == "info"
    ]
    assert all("accuracy cannot be set" in row.note or "floor" in row.note for row in errors)
    assert errors or engine is FixedTight


@pytest.mark.parametrize("engine", [FixedAndDrags, FixedAndRunsFast])
def test_a_fault_beside_it_is_caught(engine: type[Fixed]) -> None:
    assert any("as the step vanishes" in text or "too long" in text
               for text in failures(judged("t-handle", engine())))  # fmt: skip


def test_a_run_that_ends_in_nothing_fails() -> None:
    case, truth, _ = prepared("random-2")
    driver = driver_of("engine", EndsInNothing())
    result = driver.evaluate_equations(case, prepared("random-2")[2])
    result.runs.update(driver.run_all(case, lambda: None))
    with np.errstate(all="ignore"):
        runs = judge_case(truth, case, result, {})
    assert {run.outcome for run in runs} == {"diverged"}
    assert all(any(row.verdict == "fail" for row in run.rows) for run in runs)


def test_a_run_that_is_requested_again_is_the_same_or_fails() -> None:
    case, truth, states = prepared("random-2")
    found = []
    for adapter in (ErrorControlled(), LaterRunsDrag()):
        driver = driver_of("engine", adapter)
        result = driver.evaluate_equations(case, states)
        result.runs.update(driver.run_all(case, lambda: None))
        if isinstance(adapter, LaterRunsDrag):
            adapter.runs = MANY + 1
        request_again(driver, case, states, result)
        with np.errstate(all="ignore"):
            runs = judge_case(truth, case, result, {})
        rows = [row for run in runs for row in run.rows if row.metric in ("repeated", "reloaded")]
        found.append([row.verdict for row in rows])
    # two runs alike, before another system and after it, show what is left of that alone
    assert found == [["pass", "pass"], ["fail", "pass"]]


def test_the_samples_of_accuracies_are_those_of_the_steps() -> None:
    for name in NAMES:
        case, truth, _ = prepared(name)
        (sweep, *_) = case.swept_by_accuracy(0.0)
        assert np.allclose(truth.times[truth.rows(sweep)], sweep.times, rtol=1e-15, atol=0.0)
        assert sweep.times[-1] <= truth.times[-1] * (1 + 1e-15)
        finer = sweep.refined(4)
        assert finer.accuracy == sweep.accuracy
        assert np.array_equal(finer.times, sweep.times)


def test_samples_that_are_rounded_otherwise_are_found() -> None:
    scenario = load_builtin("sphere")
    run = scenario.run.model_copy(update={"timesteps": (0.003,), "sample": 0.03, "duration": 3.0})
    case = case_of(scenario.model_copy(update={"run": run}), ())
    truth = case_truth(driver_of("exact", ExactAdapter()), case)
    assert isinstance(truth, Truth)
    (sweep, *_) = case.swept_by_accuracy(0.0)
    assert not np.array_equal(sweep.times, case.sweeps[0].times)  # n * 0.03 and 10 n * 0.003
    assert np.array_equal(truth.rows(sweep), np.arange(len(truth.times)))


def test_accuracies_come_from_the_scenario_or_the_arguments() -> None:
    scenario = load_builtin("sphere")
    run = scenario.run.model_copy(update={"accuracies": (1e-4, 1e-8)})
    own = scenario.model_copy(update={"run": run})
    assert case_of(own, ()).accuracies == (1e-4, 1e-8)
    assert case_of(own, (), (1e-5,)).accuracies == (1e-5,)
    assert case_of(scenario, ()).accuracies == ACCURACIES
    integrator = replace(ErrorControlled().description.integrators[0], finest_accuracy=1e-6)
    swept = case_of(own, ()).sweeps_of(integrator)
    assert [sweep.accuracy for sweep in swept] == [1e-4, 1e-6]
