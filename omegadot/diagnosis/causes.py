"""The likeliest cause of a failing check, requested once for each integrator that fails."""

from __future__ import annotations

from functools import cache

from omegadot.diagnosis.diagnose import diagnose
from omegadot.gates.evaluation_states import evaluation_states_of
from omegadot.harness.judge import JudgedRun
from omegadot.harness.outcome import Cause, EngineCase, JudgedCase


def causes_of(judged: JudgedCase, found: EngineCase, seed: int) -> Cause:
    """For one engine on one case: a run's likeliest cause, or that of what its runs share."""

    @cache
    def named(integrator: str | None) -> str:
        assert judged.truth is not None
        runs = [run for run in found.runs if run.integrator.name == integrator]
        evaluation = evaluation_states_of(judged.case, judged.truth, seed)
        return "; ".join(diagnose(judged.case, judged.truth, evaluation, found.result, runs))

    def cause(run: JudgedRun | None) -> str:
        return named(None if run is None else run.integrator.name)

    return cause
