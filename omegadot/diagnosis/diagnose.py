"""The likeliest cause of what the gates found, as text.

``diagnose(case, truth, evaluation_states, result, runs) -> list[str]`` is a pure function of what
the harness has after judging one engine on one case: the `Case`, its `Truth` (with companions of
the schemes in question), the `EvaluationStates`, the `CaseResult` with the engine's own answers,
and the `JudgedRun` list of `judge_case`. Each sentence names a cause that was tried on
those answers and explains them within the gates' own bounds. Where nothing does, or nothing failed,
the list is empty: no guess is better than a wrong one.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

import numpy as np

from omegadot.diagnosis import equation, model
from omegadot.diagnosis.reported_run import reported_run
from omegadot.diagnosis.reported_run_causes import CAUSES_REPORTED, begin_apart
from omegadot.diagnosis.reported_sample_causes import intervals, omega_dot_late, one_field
from omegadot.diagnosis.stepping import CAUSES_OF_STEPPING, MOST_STEPS
from omegadot.gates.case import Case
from omegadot.gates.equation import EvaluationStates, evaluation_states_of
from omegadot.gates.truth import Truth
from omegadot.harness.drive import CaseResult
from omegadot.harness.judge import JudgedRun, is_finite, shared_rows
from omegadot.harness.outcome import Cause, EngineCase, JudgedCase


def causes_of(judged: JudgedCase, found: EngineCase, seed: int) -> Cause:
    """For one engine on one case: a run's likeliest cause, or that of what its runs share.

    Diagnosed on request, once for each integrator.
    """

    @cache
    def named(integrator: str | None) -> str:
        assert judged.truth is not None
        runs = [run for run in found.runs if run.integrator.name == integrator]
        evaluation_states = evaluation_states_of(judged.case, judged.truth, seed)
        return "; ".join(diagnose(judged.case, judged.truth, evaluation_states, found.result, runs))

    def cause(run: JudgedRun | None) -> str:
        return named(None if run is None else run.integrator.name)

    return cause


def diagnose(
    case: Case,
    truth: Truth,
    evaluation_states: EvaluationStates,
    result: CaseResult,
    runs: Sequence[JudgedRun],
) -> list[str]:
    """Sentences that explain the failed gates, the most basic cause first; none without failure.

    A wrong model or equation is looked for first, and explains the runs after it: these are looked
    at by themselves only where neither gate failed.
    """
    with np.errstate(all="ignore"):  # a wrong engine may answer with any numbers
        failed = {
            row.gate
            for row in shared_rows(case, evaluation_states, result)
            if row.verdict == "fail"
        }
        found: list[str] = []
        if "model" in failed:
            found += model.causes(case, evaluation_states, result)
        if "equation" in failed and not found:
            found += equation.causes(case, evaluation_states, result)
        if not failed:
            for run in _shortest_failed(runs):
                found = _of_run(case, truth, result, run)
                if found:
                    break
        return list(dict.fromkeys(found))


def _of_run(case: Case, truth: Truth, result: CaseResult, run: JudgedRun) -> list[str]:
    """Causes in what one run reports, then in its stepping, then in where it is sound.

    Where nothing but the omega-dot reported along it failed, only that is looked at.
    """
    reported = reported_run(case, truth, result, run)
    if {row.channel for row in run.rows if row.verdict == "fail"} == {"omega_dot"}:
        late = "" if reported is None else omega_dot_late(reported, result)
        return [late] if late else []
    if reported is None:
        return []
    if begin_apart(reported, result):
        return ["runs begin at other states than the one given: one is left over from a run before"]
    tried = list(CAUSES_REPORTED)
    if len(reported.time) == len(reported.sweep.times):
        if is_finite(reported.state) and reported.sweep.steps <= MOST_STEPS:
            tried += CAUSES_OF_STEPPING
        tried += (intervals, one_field)
    sentence = next(filter(None, (cause(reported) for cause in tried)), None)
    return [sentence] if sentence else []


def _shortest_failed(runs: Sequence[JudgedRun]) -> list[JudgedRun]:
    """Of each integrator the failed run of the fewest steps, for hypotheses are stepped again."""
    failed = [run for run in runs if any(row.verdict == "fail" for row in run.rows)]
    shortest: dict[str, JudgedRun] = {}
    for run in sorted(failed, key=lambda run: run.sweep.steps):
        shortest.setdefault(run.integrator.name, run)
    return list(shortest.values())
