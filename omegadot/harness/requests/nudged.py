"""Forward dynamics at states that are a few roundings off, where omega-dot is hardly wrong."""

from __future__ import annotations

from omegadot.gates.bounds.scales import ROUNDINGS_PER_EVALUATION, body_scale, eps_of
from omegadot.gates.case import Case
from omegadot.gates.states.equation import EvaluationStates
from omegadot.gates.states.own_rounding import (
    bound_of,
    may_be_rounding,
    nudged,
    rounding_shown,
)
from omegadot.harness.drive import CaseResult, Driver
from omegadot.harness.outcome import EngineCase


def rounding_may_decide(case: Case, found: EngineCase) -> bool:
    """Whether all that omega-dot is off by may be the engine's own rounding, not yet seen."""
    rows = [*found.shared, *(row for run in found.runs for row in run.rows)]
    asked = found.result.own_rounding is not None or not found.result.forward.ok
    return not asked and may_be_rounding(case.system, rows)


def request_nudged(
    driver: Driver, case: Case, evaluation_states: EvaluationStates, result: CaseResult
) -> None:
    """The bound of omega-dot by the engine's own rounding, into `result`."""
    eps, shown, scale = eps_of(result.precision), 0.0, body_scale(case.system)
    strict = ROUNDINGS_PER_EVALUATION * eps * scale.largest / scale.smallest
    for states, answer in (
        (evaluation_states.random, result.forward),
        (evaluation_states.path, result.path),
    ):
        beside = nudged(states, eps)
        again = driver.request(case, "forward", states=beside)
        if answer.ok and again.ok:
            pairs = [(states, answer.result["angular"]), (beside, again.result["angular"])]
            shown = max(shown, rounding_shown(case.system, pairs, strict))
    result.own_rounding = bound_of(case.system, shown, strict)
