"""Send one engine's answers for one scenario through the gates."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.gates import cost, equation, invariants, model, phase, scheme, trajectory
from omegadot.gates.case import Case, Sweep
from omegadot.gates.equation import EvaluationStates
from omegadot.gates.measured_run import Declared, MeasuredRun, findings_of, measure, orders_for
from omegadot.gates.rows import Row
from omegadot.gates.truth import Truth
from omegadot.gates.verdicts import Finding
from omegadot.harness.drive import CaseResult
from omegadot.harness.repeats import rows_again
from omegadot.harness.step_probes import rows_of_probes
from omegadot.reference_impl.system import Acceleration, State
from omegadot.workers.harness_end.process import Answer
from omegadot.workers.wire import body_from


@dataclass(frozen=True)
class JudgedRun:
    """One task's outcome, rows and reason. unresolved: a finer sweep could still decide."""

    integrator: Integrator
    sweep: Sweep
    outcome: str
    reason: str
    rows: list[Row] = field(default_factory=list)
    why: str = ""
    unresolved: bool = False


def shared_rows(case: Case, evaluation_states: EvaluationStates, result: CaseResult) -> list[Row]:
    """The rows that belong to engine and scenario, whatever the integrator."""
    rows: list[Row] = []
    if result.model.ok:
        found = result.model.result
        for body in found["bodies"]:
            rows += model.body_rows(case, body_from(body))
        rows += model.state_rows(case, evaluation_states.random[0], State(**found["state"]))
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
            rows += equation.forward_rows(case.system, states, acceleration, metric)
    for metric, answer, count in (
        ("residual", result.inverse, None),
        ("residual_alone", result.inverse_alone, 1),
    ):
        if answer.ok:
            states, acceleration = random[:count], evaluation_states.acceleration[:count]
            torque = answer.result["torque"]
            rows += equation.inverse_rows(case.system, states, acceleration, torque, metric)
    return rows


def is_finite(state: State) -> bool:
    """Whether every number of a trajectory is finite."""
    return all(bool(np.all(np.isfinite(values))) for values in vars(state).values())


# From the least favourable.
_FINDINGS = (
    *("unexplained", "unsettled", "unresolved", "beyond"),
    *("consistent", "explained", "round-off"),
)


def _why(findings: dict[str, Finding]) -> str:
    """One reason for the whole run: the least favourable among its channels."""
    channel = min(findings, key=lambda c: _FINDINGS.index(findings[c].kind))
    finding = findings[channel]
    alone = finding.kind in ("explained", "round-off", "beyond")
    return finding.note if alone else f"{channel}: {finding.note}"


def _measured_runs(
    truth: Truth, integrator: Integrator, answers: Iterable[tuple[Sweep, Answer]]
) -> dict[float, MeasuredRun]:
    """The runs of one integrator that can be measured: those with the samples requested."""
    measured_runs = {}
    for sweep, answer in answers:
        if answer.ok and len(answer.result["time"]) == len(sweep.times):
            own = truth.companion(integrator, sweep)
            state = State(**answer.result["state"])
            measured_runs[sweep.timestep] = measure(truth, sweep, state, own)
    return measured_runs


def _diverged(
    integrator: Integrator,
    sweep: Sweep,
    answer: Answer,
    measured: MeasuredRun,
    findings: dict[str, Finding],
) -> JudgedRun:
    """A run whose state ceases to be finite; what its scheme does as well is not judged."""
    finite = np.isfinite(measured.saturating_error) & np.isfinite(answer.result["time"])
    bad = np.flatnonzero(~finite)
    when = f" from t = {sweep.times[bad[0]]:g} s" if len(bad) else ""
    note = f"the state is not finite{when}"
    worst = min(findings.values(), key=lambda f: _FINDINGS.index(f.kind))
    rows = [
        trajectory.time_row(sweep, answer.result["time"]),
        Row("trajectory", "omega", "error_max", float("nan"), "1", None, worst.verdict, worst.note),
    ]
    why = note if worst.verdict == "fail" else worst.note
    return JudgedRun(integrator, sweep, "diverged", note, rows, why, worst.open)


def _failed(integrator: Integrator, sweep: Sweep, answer: Answer) -> JudgedRun:
    """A task without a trajectory to measure: its outcome, and the verdict on its times."""
    if not answer.ok:
        return JudgedRun(integrator, sweep, answer.outcome, answer.reason)
    rows = [trajectory.time_row(sweep, answer.result["time"])]
    return JudgedRun(integrator, sweep, "ok", "", rows, why=rows[0].note)


def _judge_integrator(
    truth: Truth,
    integrator: Integrator,
    sweeps: Iterable[Sweep],
    result: CaseResult,
    finer: Iterable[tuple[Sweep, Answer]],
) -> Iterator[JudgedRun]:
    """Judge every step size of one integrator; finer ones only serve to see its order."""
    answers = [(sweep, result.runs[integrator.name, sweep.timestep]) for sweep in sweeps]
    measured_runs = _measured_runs(truth, integrator, [*answers, *finer])
    system = truth.yardstick.system
    declared = Declared(integrator.scheme, orders_for(integrator, system))
    known = list(measured_runs.values())
    seen = scheme.orders_seen(known)
    for sweep, answer in answers:
        measured = measured_runs.get(sweep.timestep)
        if measured is None:
            yield _failed(integrator, sweep, answer)
            continue
        state = State(**answer.result["state"])
        findings = findings_of(measured, declared, known)
        if not is_finite(state):
            yield _diverged(integrator, sweep, answer, measured, findings)
            continue
        match = scheme.match_row(truth, integrator, measured, state, known)
        unknown = rows_of_probes(truth, integrator, sweep, result)
        rows = [match, *scheme.order_rows(seen, declared, measured), *unknown]
        misreported = trajectory.reported_rows(truth, measured, state, result.precision)
        misreported += trajectory.omega_dot_rows(system, state, answer.result["omega_dot"])
        misreported += rows_again(truth, integrator, sweep, result, measured)
        rows += invariants.rows(measured, findings, sweep.times)
        rows.append(trajectory.time_row(sweep, answer.result["time"]))
        rows += [*misreported, *trajectory.rows(measured, findings)]
        rows += phase.rows(truth, measured, state)
        rows += cost.rows(sweep.timestep, answer.result["seconds_per_step"])
        broken = [row.note for row in (*misreported, match, *unknown) if row.verdict == "fail"]
        why = broken[0] if broken else _why(findings)
        unresolved = any(f.open for f in findings.values())
        yield JudgedRun(integrator, sweep, "ok", "", rows, why, unresolved)


def judge_case(
    truth: Truth,
    case: Case,
    result: CaseResult,
    refinements: dict[str, dict[float, tuple[Sweep, Answer]]],
) -> list[JudgedRun]:
    """Judge every task of one engine on one scenario."""
    return [
        judged
        for integrator in result.integrators
        for judged in _judge_integrator(
            truth, integrator, case.sweeps, result, refinements.get(integrator.name, {}).values()
        )
    ]
