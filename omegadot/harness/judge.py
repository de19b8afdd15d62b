"""Send the runs of one engine on one scenario through the gates."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import TypeVar

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.gates.bounds.scales import EPS, ROUNDINGS_PER_EVALUATION
from omegadot.gates.case import Case, Sweep
from omegadot.gates.errors import rounding_step
from omegadot.gates.errors.measured_run import (
    STATE,
    Declared,
    MeasuredRun,
    errors_of,
    findings_of,
    measure,
    orders_for,
)
from omegadot.gates.errors.verdicts import Finding
from omegadot.gates.rows import Row
from omegadot.gates.runs import cost, invariants, phase, trajectory
from omegadot.gates.steps import accuracy, accuracy_followed, scheme
from omegadot.gates.steps.vanishing_step import UNDETERMINED
from omegadot.gates.truth import Truth
from omegadot.harness.drive import CaseResult
from omegadot.harness.judge_engine import held
from omegadot.harness.no_solution import (
    NO_ROOT,
    is_lost,
    reason_without_a_solution,
    unjudged_row,
)
from omegadot.harness.repeats import rows_again
from omegadot.harness.step_probes import rows_of_probes
from omegadot.reference_impl.system import State
from omegadot.workers.harness_end.process import Answer

Run = TypeVar("Run", bound=MeasuredRun)


@dataclass(frozen=True)
class JudgedRun:
    """One task's outcome, rows and reason.

    unresolved: a finer sweep could still decide.  finer: that sweep, where it is not half the step.
    """

    integrator: Integrator
    sweep: Sweep
    outcome: str
    reason: str
    rows: list[Row] = field(default_factory=list)
    why: str = ""
    unresolved: bool = False
    finer: Sweep | None = None


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
    measured: Callable[[Sweep, State], Run], answers: Iterable[tuple[Sweep, Answer]]
) -> dict[Sweep, Run]:
    """The runs of one integrator that can be measured: those with the samples requested."""
    return {
        sweep: measured(sweep, State(**answer.result["state"]))
        for sweep, answer in answers
        if answer.ok and len(answer.result["time"]) == len(sweep.times)
    }


def _diverged(
    integrator: Integrator,
    sweep: Sweep,
    answer: Answer,
    measured: MeasuredRun,
    findings: dict[str, Finding],
    eps: float,
) -> JudgedRun:
    """A run whose state ceases to be finite; what its scheme does as well is not judged.

    Energy and angular momentum follow from the state, and overflow before it.
    """
    finite = np.isfinite(measured.saturating_error) & np.isfinite(answer.result["time"])
    bad = np.flatnonzero(~finite)
    when = f" from t = {sweep.times[bad[0]]:g} s" if len(bad) else ""
    note = f"the state is not finite{when}"
    of_state = [finding for channel, finding in findings.items() if channel in STATE]
    worst = min(of_state, key=lambda f: _FINDINGS.index(f.kind))
    rows = [
        trajectory.time_row(sweep, answer.result["time"], eps),
        Row("trajectory", "omega", "error_max", float("nan"), "1", None, worst.verdict, worst.note),
    ]
    why = note if worst.verdict == "fail" else worst.note
    return JudgedRun(integrator, sweep, "diverged", note, rows, why, worst.open)


def _failed(integrator: Integrator, sweep: Sweep, answer: Answer, eps: float) -> JudgedRun:
    """A task without a trajectory to measure: its outcome, and the verdict on its times."""
    if not answer.ok:
        return JudgedRun(integrator, sweep, answer.outcome, answer.reason)
    rows = [trajectory.time_row(sweep, answer.result["time"], eps)]
    if is_finite(State(**answer.result["state"])):
        return JudgedRun(integrator, sweep, "ok", "", rows, why=rows[0].note)
    note = "the state is not finite"
    rows.append(Row("trajectory", "omega", "error_max", float("nan"), "1", None, "fail", note))
    return JudgedRun(integrator, sweep, "diverged", note, rows, why=note)


def _judge_integrator(
    truth: Truth,
    integrator: Integrator,
    sweeps: Iterable[Sweep],
    result: CaseResult,
    finer: Iterable[tuple[Sweep, Answer]],
) -> Iterator[JudgedRun]:
    """Judge every step size of one integrator; finer ones only serve to see its order."""
    answers = [(sweep, result.runs[integrator.name, sweep.knob]) for sweep in sweeps]

    def next_to_its_scheme(sweep: Sweep, state: State) -> MeasuredRun:
        own = truth.companion(integrator, sweep)
        return measure(truth if own else truth.of_kept(sweep, state), sweep, state, own)

    measured_runs = _measured_runs(next_to_its_scheme, [*answers, *finer])
    system, eps = truth.yardstick.system, truth.yardstick.eps
    states = {s: State(**a.result["state"]) for s, a in answers if s in measured_runs}
    lost = [s for s, state in states.items() if is_lost(integrator, system, s, state, eps)]
    measured_runs = {s: one for s, one in measured_runs.items() if s not in lost}
    declared = Declared(integrator.scheme, orders_for(integrator, system))
    known = list(measured_runs.values())
    seen, grows = scheme.orders_seen(known), rounding_step.rows(known, declared, eps)
    for sweep, answer in answers:
        if sweep in lost:
            rows = [trajectory.time_row(sweep, answer.result["time"], eps), unjudged_row(NO_ROOT)]
            yield JudgedRun(integrator, sweep, "diverged", NO_ROOT, rows, NO_ROOT)
            continue
        measured = measured_runs.get(sweep)
        if measured is None:
            note = reason_without_a_solution(truth, integrator, sweep, answers)
            unsolved = JudgedRun(integrator, sweep, "diverged", note, [unjudged_row(note)], note)
            yield unsolved if note else _failed(integrator, sweep, answer, eps)
            continue
        state = states[sweep]
        findings = findings_of(measured, declared, known)
        if not is_finite(state):
            findings = _undetermined(truth, findings)
            yield _diverged(integrator, sweep, answer, measured, findings, eps)
            continue
        if integrator.knob == "fixed-accuracy":
            findings = accuracy.fixed(findings)
        match = scheme.match_row(truth, integrator, measured, state, known)
        orders = scheme.order_rows(seen, declared, measured)
        if integrator.knob == "fixed-accuracy":
            orders = accuracy.fixed_orders(orders)
        probed = rows_of_probes(truth, integrator, sweep, result)
        probed += rows_again(truth, integrator, sweep, result, measured)
        rows, broken = _rows_of_run(truth, measured, findings, answer, result)
        broken += [row.note for row in (match, *probed) if row.verdict == "fail"]
        why = broken[0] if broken else "; ".join([_why(findings), *(r.note for r in grows[:1])])
        # what is broken at this step stays so, whatever finer ones show
        unresolved = not broken and _finer_steps_decide(findings, known)
        rows = [match, *orders, *grows, *probed, *rows]
        yield JudgedRun(integrator, sweep, "ok", "", rows, why, unresolved)


def _undetermined(truth: Truth, findings: dict[str, Finding]) -> dict[str, Finding]:
    """The findings on a run that overflows: none where rounding leaves no digit of omega-dot.

    In single precision ``64 eps J / lambda`` may reach one. What steps the angular momentum then
    turns its rounding into an omega of the motion's own size, and more at the next step.
    """
    scale, eps = truth.yardstick.scale, truth.yardstick.eps
    if ROUNDINGS_PER_EVALUATION * eps * scale.largest < scale.smallest or eps <= EPS:
        return findings
    return dict.fromkeys(findings, Finding("beyond", UNDETERMINED))


def _finer_steps_decide(findings: dict[str, Finding], known: Sequence[MeasuredRun]) -> bool:
    """Whether a finer step could still decide what is open.

    Of an unknown scheme it does not where an order is hidden, and rounding hides the error of the
    finest step: it hides those of finer ones all the more.
    """
    finest = min(known, key=lambda run: run.sweep.timestep)
    still = {channel: finding for channel, finding in findings.items() if finding.open}
    if finest.single or finest.against_scheme:
        return bool(still)
    errors = {channel: errors_of(finest, channel) for channel in still}
    shown = {channel for channel, one in errors.items() if one is not None and one.shows}
    return any(f.kind != "unresolved" or channel in shown for channel, f in still.items())


def _rows_of_run(
    truth: Truth,
    measured: MeasuredRun,
    findings: dict[str, Finding],
    answer: Answer,
    result: CaseResult,
) -> tuple[list[Row], list[str]]:
    """The rows of one run, whatever its knob, and the notes of what it misreports."""
    system, eps = truth.yardstick.system, truth.yardstick.eps
    state, sweep = State(**answer.result["state"]), measured.sweep
    misreported = trajectory.reported_rows(truth, measured, state, result.precision)
    omega_dot = trajectory.omega_dot_rows(system, state, answer.result["omega_dot"], eps)
    misreported += held(result, omega_dot)
    rows = invariants.rows(measured, findings, sweep.times)
    rows.append(trajectory.time_row(sweep, answer.result["time"], eps))
    rows += [*misreported, *trajectory.rows(measured, findings)]
    rows += phase.rows(truth, measured, state)
    rows += cost.rows(sweep, answer.result["seconds_per_step"])
    return rows, [row.note for row in misreported if row.verdict == "fail"]


def _judge_accuracies(
    truth: Truth,
    integrator: Integrator,
    sweeps: Iterable[Sweep],
    result: CaseResult,
    finer: Iterable[tuple[Sweep, Answer]],
) -> Iterator[JudgedRun]:
    """Judge every accuracy of one integrator; finer ones serve to see whether its error follows."""
    answers = [(sweep, result.runs[integrator.name, sweep.knob]) for sweep in sweeps]
    eps, measure_one = truth.yardstick.eps, partial(accuracy.measure_accuracy, truth, integrator)
    measured_runs = _measured_runs(measure_one, [*answers, *finer])
    known = list(measured_runs.values())
    further = accuracy_followed.finer_sweep(truth, integrator, known) if known else None
    for sweep, answer in answers:
        measured = measured_runs.get(sweep)
        if measured is None:
            yield _failed(integrator, sweep, answer, eps)
            continue
        findings = accuracy_followed.findings_of(measured, known)
        if not is_finite(State(**answer.result["state"])):
            yield _diverged(integrator, sweep, answer, measured, findings, eps)
            continue
        probed = rows_of_probes(truth, integrator, sweep, result)
        probed += rows_again(truth, integrator, sweep, result, measured)
        rows, broken = _rows_of_run(truth, measured, findings, answer, result)
        broken += [row.note for row in probed if row.verdict == "fail"]
        why = broken[0] if broken else _why(findings)
        rows = [*accuracy_followed.rows(measured, known), *probed, *rows]
        unresolved = not broken and further is not None
        yield JudgedRun(integrator, sweep, "ok", "", rows, why, unresolved, further)


def judge_case(
    truth: Truth,
    case: Case,
    result: CaseResult,
    refinements: dict[str, dict[Sweep, tuple[Sweep, Answer]]],
) -> list[JudgedRun]:
    """Judge every task of one engine on one scenario."""
    truth = truth.in_precision(result.precision)
    found: list[JudgedRun] = []
    for integrator in result.integrators:
        finer = refinements.get(integrator.name, {}).values()
        judge = _judge_accuracies if integrator.knob == "accuracy" else _judge_integrator
        found += judge(truth, integrator, case.sweeps_of(integrator), result, finer)
    return found
