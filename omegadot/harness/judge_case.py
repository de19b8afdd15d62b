"""Send one engine's answers for one scenario through the gates."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.adapters.wire import acceleration_from, body_from, state_from
from omegadot.harness.drive import CaseResult, Questions
from omegadot.harness.gates import (
    cost,
    equation,
    invariants,
    model,
    phase,
    scheme,
    told,
    trajectory,
)
from omegadot.harness.gates.course import (
    Course,
    Declared,
    findings_of,
    measure,
    orders_for,
    scheme_key,
)
from omegadot.harness.plan import Case, Sweep
from omegadot.harness.rows import Row, worst
from omegadot.harness.truth import Truth
from omegadot.harness.unknown_schemes import rows_of_unknown
from omegadot.harness.verdicts import Finding
from omegadot.harness.worker_process import Answer
from omegadot.reference_impl.system import State

GATES = ("model", "equation", "scheme", "invariants", "trajectory", "cost")


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

    def verdicts(self) -> dict[str, str]:
        """The worst verdict per gate that was reached."""
        found = {gate: worst(r.verdict for r in self.rows if r.gate == gate) for gate in GATES}
        return {gate: verdict for gate, verdict in found.items() if verdict is not None}


def shared_rows(case: Case, questions: Questions, result: CaseResult) -> list[Row]:
    """The rows that belong to engine and scenario, whatever the integrator."""
    rows: list[Row] = []
    if result.model.ok:
        answer = result.model.result
        for body in answer["bodies"]:
            rows += model.body_rows(case, body_from(body))
        first = State(*(values[0] for values in vars(questions.random).values()))
        rows += model.state_rows(case, first, state_from(answer["state"]))
    named = {"residual": (result.forward, questions.random)}
    named["residual_on_path"] = (result.path, questions.path)
    for metric, (found, states) in named.items():
        if found.ok:
            acceleration = acceleration_from(found.result)
            rows += equation.forward_rows(case.system, states, acceleration, metric)
    if result.inverse.ok:
        torque = result.inverse.result["torque"]
        rows += equation.inverse_rows(case.system, questions.random, questions.asked, torque)
    return rows


def _is_finite(state: State) -> bool:
    return all(bool(np.all(np.isfinite(values))) for values in vars(state).values())


def _why(findings: dict[str, Finding]) -> str:
    """One reason for the whole run: the least favourable among its channels."""
    order = ["unexplained", "unresolved", "beyond", "consistent", "explained", "round-off"]
    channel = min(findings, key=lambda c: order.index(findings[c].kind))
    finding = findings[channel]
    alone = finding.kind in ("explained", "round-off", "beyond")
    return finding.note if alone else f"{channel}: {finding.note}"


def _courses(
    truth: Truth, integrator: Integrator, answers: dict[float, Answer], sweeps: list[Sweep]
) -> dict[float, Course]:
    """The runs of one integrator that can be measured: finite, with the samples asked for."""
    courses, key = {}, scheme_key(integrator, truth.yardstick.system)
    for sweep in sweeps:
        answer = answers[sweep.timestep]
        if not answer.ok or len(answer.result["time"]) != len(sweep.times):
            continue
        state = state_from(answer.result["state"])
        if _is_finite(state):
            companion = truth.companions.get((key, sweep.timestep)) if key else None
            courses[sweep.timestep] = measure(
                truth.yardstick, sweep, truth.samples(sweep), state, companion
            )
    return courses


def _failed(integrator: Integrator, sweep: Sweep, answer: Answer) -> JudgedRun:
    """A task without a course to measure: its outcome, and what can be said of its times."""
    if not answer.ok:
        return JudgedRun(integrator, sweep, answer.outcome, answer.reason)
    rows = [trajectory.time_row(sweep, answer.result["time"])]
    state = state_from(answer.result["state"])
    if _is_finite(state):
        return JudgedRun(integrator, sweep, "ok", "", rows, why=rows[0].note)
    finite = np.isfinite(state.orientation).all(-1) & np.isfinite(state.angular_velocity).all(-1)
    bad = np.flatnonzero(~finite & np.isfinite(answer.result["time"]))
    when = f" from t = {answer.result['time'][bad[0]]:g} s" if len(bad) else ""
    note = f"the state is not finite{when}"
    rows.append(
        Row("trajectory", "omega", "error_max", float("nan"), "1", None, "fail", "diverged")
    )
    return JudgedRun(integrator, sweep, "diverged", note, rows, why=note)


def judge_integrator(
    truth: Truth,
    integrator: Integrator,
    sweeps: list[Sweep],
    answers: dict[float, Answer],
    refinements: dict[float, tuple[Sweep, Answer]],
    result: CaseResult | None = None,
) -> Iterator[JudgedRun]:
    """Judge every step size of one integrator; refinements only serve to see its order.

    result: what else the engine answered, where its scheme is unknown.
    """
    result = result or CaseResult("", "")
    finer = {step: answer for step, (_, answer) in refinements.items()}
    every = [*sweeps, *(sweep for sweep, _ in refinements.values())]
    courses = _courses(truth, integrator, {**answers, **finer}, every)
    declared = Declared(integrator.scheme, orders_for(integrator, truth.yardstick.system))
    known = list(courses.values())
    seen = scheme.orders_seen(known)
    for sweep in sweeps:
        answer, course = answers[sweep.timestep], courses.get(sweep.timestep)
        if course is None:
            yield _failed(integrator, sweep, answer)
            continue
        state = state_from(answer.result["state"])
        findings = findings_of(course, declared, known)
        match = scheme.match_row(truth, integrator, course, state, known)
        system = truth.yardstick.system
        rows = [match, *scheme.order_rows(seen, declared, course)]
        unknown = rows_of_unknown(truth, system, integrator, sweep, result)
        told_wrong = told.rows(truth, course, state, result.precision)
        told_wrong += told.omega_dot_rows(system, state, answer.result["omega_dot"])
        rows += unknown
        rows += invariants.rows(course, findings, sweep.times)
        rows.append(trajectory.time_row(sweep, answer.result["time"]))
        rows += [*told_wrong, *trajectory.rows(course, findings)]
        rows += phase.rows(truth, course, state)
        rows += cost.rows(sweep.timestep, answer.result["seconds_per_step"])
        broken = [row.note for row in (*told_wrong, match, *unknown) if row.verdict == "fail"]
        why = broken[0] if broken else _why(findings)
        unresolved = any(f.kind == "unresolved" for f in findings.values())
        yield JudgedRun(integrator, sweep, "ok", "", rows, why, unresolved)


def judge_case(
    truth: Truth,
    case: Case,
    result: CaseResult,
    refinements: dict[str, dict[float, tuple[Sweep, Answer]]],
) -> list[JudgedRun]:
    """Judge every task of one engine on one scenario."""
    sweeps, judged = list(case.sweeps), []
    for integrator in result.integrators:
        answers = {s.timestep: result.runs[integrator.name, s.timestep] for s in sweeps}
        finer = refinements.get(integrator.name, {})
        judged += list(judge_integrator(truth, integrator, sweeps, answers, finer, result))
    return judged
