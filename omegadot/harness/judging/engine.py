"""Send what one engine answers of a scenario, besides its runs, through the gates."""

from __future__ import annotations

from omegadot.gates.bounds.scales import eps_of
from omegadot.gates.case import Case
from omegadot.gates.rows import Row
from omegadot.gates.states import equation, model
from omegadot.gates.states.equation import EvaluationStates
from omegadot.gates.states.own_rounding import of_own_rounding
from omegadot.harness.drive import CaseResult
from omegadot.harness.requests.siblings import rows_of_siblings
from omegadot.reference_impl.system import Acceleration, State
from omegadot.workers.wire import body_from


def shared_rows(case: Case, evaluation_states: EvaluationStates, result: CaseResult) -> list[Row]:
    """The rows that belong to engine and scenario, whatever the integrator."""
    rows: list[Row] = []
    eps = eps_of(result.precision)
    if result.model.ok:
        found = result.model.result
        for body in found["bodies"]:
            rows += model.body_rows(case, body_from(body), eps)
        rows += model.state_rows(case, evaluation_states.random[0], State(**found["state"]), eps)
    random = evaluation_states.random
    named = {
        "residual": (result.forward, random),
        "residual_on_path": (result.path, evaluation_states.path),
        "residual_alone": (result.alone, random[:1]),
        "residual_reloaded": (result.reloaded, random),
    }
    for metric, (answer, states) in named.items():
        if answer.ok:
            acceleration = Acceleration(**answer.result)
            rows += equation.forward_rows(case.system, states, acceleration, metric, eps)
    rows += rows_of_siblings(result, eps)
    for metric, answer, count in (
        ("residual", result.inverse, None),
        ("residual_alone", result.inverse_alone, 1),
    ):
        if answer.ok:
            states, acceleration = random[:count], evaluation_states.acceleration[:count]
            torque = answer.result["torque"]
            rows += equation.inverse_rows(case.system, states, acceleration, torque, metric, eps)
    return held(result, rows)


def held(result: CaseResult, rows: list[Row]) -> list[Row]:
    """The rows at the bounds of a body that went in as it did, and of the engine's own rounding."""
    rows = [model.of_read_body(row) for row in rows] if result.via else rows
    own = result.own_rounding
    return rows if own is None else [of_own_rounding(row, own) for row in rows]
