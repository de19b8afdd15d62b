"""Forward dynamics at states that are a few roundings off, where omega-dot is hardly wrong."""

from __future__ import annotations

from omegadot.gates.bounds.scales import eps_of, omega_dot_bound
from omegadot.gates.case import Case
from omegadot.gates.states.equation import EvaluationStates
from omegadot.gates.states.own_rounding import (
    bound_of,
    may_be_rounding,
    nudged,
    rounding_shown,
)
from omegadot.harness.drive import Driver
from omegadot.harness.outcome import EngineCase


def rounding_may_decide(case: Case, found: EngineCase) -> bool:
    """Whether all that omega-dot is off by may be the engine's own rounding, not yet seen."""
    rows = [*found.shared, *(row for run in found.runs for row in run.rows)]
    requested = found.result.own_rounding is not None or not found.result.forward.ok
    return not requested and may_be_rounding(case.system, rows)


def request_nudged(driver: Driver, case: Case, found: EngineCase, states: EvaluationStates) -> None:
    """The bound of omega-dot by the engine's own rounding, into the result."""
    result = found.result
    eps, shown = eps_of(result.precision), 0.0
    strict = omega_dot_bound(case.system, eps)
    for own, answer in ((states.random, result.forward), (states.path, result.path)):
        beside = nudged(own, eps)
        again = driver.request(case, "forward", states=beside)
        if answer.ok and again.ok:
            pairs = [(own, answer.result["angular"]), (beside, again.result["angular"])]
            shown = max(shown, rounding_shown(case.system, pairs, strict))
    result.own_rounding = bound_of(case.system, shown, strict)
