"""Causes in the runs of one integrator: in what is reported, in the stepping, in the past."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from omegadot.diagnosis.reported.clock import clock_cause
from omegadot.diagnosis.reported.run import ReportedRun, reported_run, reported_run_guesses
from omegadot.diagnosis.reported.run_causes import CAUSES_REPORTED, begin_apart
from omegadot.diagnosis.reported.sample_causes import intervals, omega_dot_late, one_field
from omegadot.diagnosis.stepping.restarts import restart_cause
from omegadot.diagnosis.stepping.wrong_steps import (
    CAUSES_OF_STEPPING,
    CAUSES_OF_UNKNOWN,
    MOST_STEPS,
    precision_reported,
)
from omegadot.diagnosis.wording.kinds import is_fact, kind_of
from omegadot.gates.case import Case
from omegadot.gates.truth import Truth
from omegadot.harness.drive import CaseResult
from omegadot.harness.judge import JudgedRun, is_finite

MOST_TRIED = 1000  # steps of a second run, in which a cause is looked for again


def run_causes(
    case: Case, truth: Truth, result: CaseResult, runs: Sequence[JudgedRun]
) -> list[str]:
    """Of the failed run of the fewest steps in which one is found: hypotheses are stepped again."""
    truth = truth.in_precision(result.precision)
    failed = [run for run in runs if any(row.verdict == "fail" for row in run.rows)]
    for run in failed:
        answer = result.runs.get((run.integrator.name, run.sweep.knob))
        if answer is not None and answer.ok:
            text = clock_cause(answer.result["time"], run.sweep, truth.yardstick.eps)
            if text:
                return [text]
    several = _of_several_schemes(case, truth, result, runs) if failed else ""
    if several:
        return [several]
    for run in sorted(failed, key=lambda run: run.sweep.steps):
        text = _of_run(case, truth, result, run)
        if text and _explains_others(text, case, truth, result, run, failed):
            return [text + _at_long_steps(runs)]
        if text:
            return []
    return []


def _explains_others(
    text: str,
    case: Case,
    truth: Truth,
    result: CaseResult,
    run: JudgedRun,
    failed: Sequence[JudgedRun],
) -> bool:
    """Whether the next failed run, if it is short, has the same cause, by other numbers maybe."""
    longer = [one for one in failed if run.sweep.steps < one.sweep.steps <= MOST_TRIED]
    if not longer or is_fact(text):
        return True
    other = _of_run(case, truth, result, min(longer, key=lambda one: one.sweep.steps))
    return kind_of(other) == kind_of(text) or is_fact(other)


def _of_several_schemes(
    case: Case, truth: Truth, result: CaseResult, runs: Sequence[JudgedRun]
) -> str:
    """Runs of one integrator that are different schemes' at different steps, none declared."""
    named = dict[float, set[str]]()
    for run in runs:
        for guess in reported_run_guesses(case, truth, result, run):
            if guess.is_own:
                known = named.setdefault(run.sweep.timestep, set())
                known.add(guess.integrator.scheme or "")
    if len(named) < 2 or set.intersection(*named.values()):
        return ""
    parts = [f"{' or '.join(sorted(n))} at {h:g} s" for h, n in sorted(named.items())]
    return f"runs with different steps are of different schemes: {', '.join(parts)}"


def _at_long_steps(runs: Sequence[JudgedRun]) -> str:
    """Where the longer steps alone fail, between which steps it begins."""
    failed, sound = (
        [r.sweep.timestep for r in runs if any(row.verdict == "fail" for row in r.rows) is wrong]
        for wrong in (True, False)
    )
    if not failed or not sound or max(sound) >= min(failed):
        return ""
    return f", at steps of {min(failed):g} s and longer; steps of {max(sound):g} s are sound"


def _of_run(case: Case, truth: Truth, result: CaseResult, run: JudgedRun) -> str:
    """Causes in what one run reports, then in its stepping, then in where it is sound.

    Where nothing but the omega-dot reported along it failed, only that is looked at.
    """
    reported = reported_run(case, truth, result, run)
    if {row.channel for row in run.rows if row.verdict == "fail"} == {"omega_dot"}:
        return omega_dot_late(case, truth, result, run)
    if reported is not None:
        return _of_reported(reported, result)
    text = next(_of_guesses(case, truth, result, run), "")
    return text or restart_cause(truth, result, run)


def _of_reported(reported: ReportedRun, result: CaseResult) -> str:
    if not reported.is_declared and reported.is_own:
        return ""  # nothing in this run is wrong
    if len(reported.time) == len(reported.sweep.times) and is_finite(reported.state):
        text = precision_reported(reported)
        if text:
            return text
    if begin_apart(reported, result):
        return "runs begin at other states than the one given: one is left over from a run before"
    tried = list(CAUSES_REPORTED)
    if len(reported.time) == len(reported.sweep.times):
        if is_finite(reported.state) and reported.sweep.steps <= MOST_STEPS:
            tried += CAUSES_OF_STEPPING if reported.is_declared else CAUSES_OF_UNKNOWN
        tried += (intervals, one_field)
    return next(filter(None, (cause(reported) for cause in tried)), "")


def _of_guesses(case: Case, truth: Truth, result: CaseResult, run: JudgedRun) -> Iterator[str]:
    """By the schemes of the reference that come nearest, where none is declared."""
    for guess in reported_run_guesses(case, truth, result, run):
        text = _of_reported(guess, result)
        if text:
            yield text
