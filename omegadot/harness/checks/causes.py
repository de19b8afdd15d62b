"""The likeliest cause of a failing check, asked once for each integrator that fails."""

from __future__ import annotations

from functools import cache

from omegadot.harness.checks.judge import Cause
from omegadot.harness.diagnose import diagnose
from omegadot.harness.judge_case import JudgedRun
from omegadot.harness.outcome import EngineCase, JudgedCase
from omegadot.harness.questions import questions_of


def causes_of(judged: JudgedCase, found: EngineCase, seed: int) -> Cause:
    """For one engine on one case: a run's likeliest cause, or that of what its runs share."""

    @cache
    def named(integrator: str | None) -> str:
        assert judged.truth is not None
        runs = [run for run in found.runs if run.integrator.name == integrator]
        questions = questions_of(judged.case, judged.truth, seed)
        return "; ".join(diagnose(judged.case, judged.truth, questions, found.result, runs))

    def cause(run: JudgedRun | None) -> str:
        return named(None if run is None else run.integrator.name)

    return cause
