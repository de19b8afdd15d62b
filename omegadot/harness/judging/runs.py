"""Send the runs of one engine on one scenario through the gates."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from omegadot.adapters.protocol import Integrator
from omegadot.gates.bounds.scales import EPS, omega_dot_bound
from omegadot.gates.case import Case, Sweep
from omegadot.gates.errors import coordinates, rounding_step
from omegadot.gates.errors.findings import (
    Declared,
    MeasuredSweep,
    errors_of,
    findings_of,
    orders_for,
)
from omegadot.gates.errors.measured_run import MeasuredRun, measure
from omegadot.gates.errors.verdicts import Finding
from omegadot.gates.runs import trajectory
from omegadot.gates.steps import accuracy, scheme
from omegadot.gates.steps.vanishing_step import UNDETERMINED
from omegadot.gates.truth import Truth
from omegadot.harness.drive import CaseResult
from omegadot.harness.judging.accuracies import judge_accuracies
from omegadot.harness.judging.judged_run import (
    JudgedRun,
    diverged,
    failed,
    is_finite,
    measured_runs_of,
    why_of,
)
from omegadot.harness.judging.no_solution import (
    NO_ROOT,
    is_lost,
    reason_without_a_solution,
    unjudged_row,
)
from omegadot.harness.judging.probed import rows_with_probes
from omegadot.harness.judging.raised import judge_raised
from omegadot.harness.requests.step_probes import roundings_in
from omegadot.reference_impl.system import State
from omegadot.workers.harness_end.process import Answer


def _judge_steps(
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

    measured_runs = measured_runs_of(next_to_its_scheme, [*answers, *finer])
    system, eps = truth.yardstick.system, truth.yardstick.eps
    states = {s: State(**a.result["state"]) for s, a in answers if s in measured_runs}
    lost = [s for s, state in states.items() if is_lost(integrator, system, s, state, eps)]
    measured_runs = {s: one for s, one in measured_runs.items() if s not in lost}
    declared = Declared(integrator.scheme, orders_for(integrator, system))
    known = list(measured_runs.values())
    together = MeasuredSweep(tuple(known))
    refused = any(answer.outcome == "unsupported" for _, answer in finer)
    seen, grows = scheme.orders_seen(together), rounding_step.rows(known, declared, eps)
    for sweep, answer in answers:
        if sweep in lost:
            rows = [trajectory.time_row(sweep, answer.result["time"], eps), unjudged_row(NO_ROOT)]
            yield JudgedRun(integrator, sweep, "diverged", NO_ROOT, rows, NO_ROOT)
            continue
        measured = measured_runs.get(sweep)
        if measured is None:
            note = reason_without_a_solution(truth, integrator, sweep, answers)
            begun = result.begun.get((integrator.name, sweep.timestep))
            if note:
                rows = [unjudged_row(note)]
                yield JudgedRun(integrator, sweep, "diverged", note, rows, note)
            elif begun is not None:
                tried = [*answers, *finer]
                yield judge_raised(truth, integrator, sweep, begun, tried, declared, known)
            else:
                yield failed(integrator, sweep, answer, eps)
            continue
        state = states[sweep]
        findings = findings_of(measured, declared, together)
        findings = _left_open(findings) if refused else findings
        if not is_finite(state):
            findings = _undetermined(truth, findings)
            yield diverged(integrator, sweep, answer, measured, findings, eps)
            continue
        by_axes = coordinates.may_decide(truth, measured, findings)
        if by_axes and (integrator.name, sweep.knob) in result.turned:
            turned = result.turned[integrator.name, sweep.knob]
            again = [measure(truth, sweep, one, None) for one in turned]
            findings = coordinates.in_other_worlds(measured, findings, again, declared, together)
            by_axes = False
        if integrator.knob == "fixed-accuracy":
            findings = accuracy.fixed(findings)
        match = scheme.match_row(truth, integrator, measured, state)
        orders = scheme.order_rows(seen, declared, measured, min(r.stiffness for r in known))
        if integrator.knob == "fixed-accuracy":
            orders = accuracy.fixed_orders(orders)
        own = [match.note] if match.verdict == "fail" else []
        rows, broken = rows_with_probes(truth, integrator, measured, findings, answer, result, own)
        why = broken[0] if broken else "; ".join([why_of(findings), *(r.note for r in grows[:1])])
        # what is broken at this step stays so, whatever finer ones show
        unresolved = not broken and _finer_steps_decide(findings, known)
        rows = [match, *orders, *grows, *rows]
        yield JudgedRun(integrator, sweep, "ok", "", rows, why, unresolved, by_axes=by_axes)


def _left_open(findings: dict[str, Finding]) -> dict[str, Finding]:
    """The findings of an engine that refuses the finer steps which would decide what is open."""
    return {
        channel: replace(one, kind="unresolved", note=f"{one.note}; finer steps are refused")
        if one.kind == "unsettled"
        else one
        for channel, one in findings.items()
    }


def _undetermined(truth: Truth, findings: dict[str, Finding]) -> dict[str, Finding]:
    """The findings on a run that overflows: none where rounding leaves no digit of omega-dot.

    In single precision ``64 eps J / lambda`` may reach one. What steps the angular momentum then
    turns its rounding into an omega of the motion's own size, and more at the next step.
    """
    system, eps = truth.yardstick.system, truth.yardstick.eps
    if omega_dot_bound(system, eps) < 1.0 or eps <= EPS:
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
        judge = judge_accuracies if integrator.knob == "accuracy" else _judge_steps
        own = truth.of_roundings(roundings_in(case.system, result, integrator))
        found += judge(own, integrator, case.sweeps_of(integrator), result, finer)
    return found
