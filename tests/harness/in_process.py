"""Engines, the truth and the gates in this very process: what workers would answer, at once."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from omegadot.adapters.protocol import Integrator
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.gates.case import Case
from omegadot.gates.truth import SchemeKey, Truth
from omegadot.harness import in_process
from omegadot.harness.arguments import case_of
from omegadot.harness.drive import CaseResult
from omegadot.harness.judging.judged_run import JudgedRun
from omegadot.harness.judging.runs import judge_case
from omegadot.harness.outcome import EngineCase
from omegadot.harness.plan import Engine, EngineChoice
from omegadot.harness.requests.truth_requests import case_companions, case_truth
from omegadot.reference_impl.schemes import COMMON, SCHEMES
from omegadot.scenarios import load_builtin
from omegadot.workers.harness_end.process import Answer


class Local(in_process.Local):
    """An adapter that answers requests about a case as a worker would."""

    def request(self, case: Case, operation: str, **fields: Any) -> Answer:  # type: ignore[override]
        self.adapter.load(case.system)
        answer = super().request(operation, **fields)
        assert answer.ok, answer.reason
        return answer


def builtin(name: str, *timesteps: float) -> Case:
    """A built-in scenario, with other steps where some are given."""
    return case_of(load_builtin(name), timesteps)


def truth_of(case: Case, schemes: tuple[str, ...] = tuple(COMMON)) -> Truth:
    """The truth with these schemes stepped in addition."""
    local: Any = Local(ReferenceAdapter())
    truth = case_truth(local, case)
    assert isinstance(truth, Truth), truth
    keys = [SchemeKey(name) for name in schemes]
    truth.companions.update(case_companions(local, case, truth, keys, case.sweeps))
    return truth


def answers_of(case: Case, adapter: Any, integrator: str) -> dict[float, Answer]:
    """The runs of one integrator, by step."""
    local = Local(adapter)
    plan = {"initial": case.initial, "integrator": integrator}
    return {
        s.timestep: local.request(
            case, "run", **plan, timestep=s.timestep, steps=s.steps, every=s.every
        )
        for s in case.sweeps
    }


def declared(name: str, scheme: str | None = None, order: int | None = None) -> Integrator:
    """An integrator that reports of itself what one likes."""
    orders = dict.fromkeys(SCHEMES["lie-rk4"].orders, order) if order else {}
    return Integrator(name, scheme, orders)


def judged(
    case: Case, truth: Truth, integrator: Integrator, adapter: Any = None, steps: str = ""
) -> list[JudgedRun]:
    """An integrator sent through the gates. steps: the reference's scheme that it really takes."""
    answers = answers_of(case, adapter or ReferenceAdapter(), steps or integrator.name)
    runs = {(integrator.name, step): answer for step, answer in answers.items()}
    return judge_case(truth, case, CaseResult((integrator,), runs=runs), {})


def engine_case(
    case: Case, truth: Truth, name: str, *integrators: tuple[Integrator, str]
) -> EngineCase:
    """An engine of several integrators, each with the scheme that it really takes."""
    adapter, own = ReferenceAdapter(), tuple(integrator for integrator, _ in integrators)
    result = CaseResult(own)
    for integrator, steps in integrators:
        answers = answers_of(case, adapter, steps)
        result.runs.update({(integrator.name, step): a for step, a in answers.items()})
    description = replace(adapter.description, name=name, integrators=own)
    engine = Engine(EngineChoice(name, ""), description, own)
    return EngineCase(engine, result, [], judge_case(truth, case, result, {}))
