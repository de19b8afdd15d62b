"""Send the runs of one error-controlled integrator through the gates."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import partial

from omegadot.adapters.protocol import Integrator
from omegadot.gates.case import Sweep
from omegadot.gates.steps import accuracy, accuracy_followed
from omegadot.gates.truth import Truth
from omegadot.harness.drive import CaseResult
from omegadot.harness.judging.judged_run import (
    JudgedRun,
    diverged,
    failed,
    is_finite,
    measured_runs_of,
    why_of,
)
from omegadot.harness.judging.probed import rows_with_probes
from omegadot.reference_impl.system import State
from omegadot.workers.harness_end.process import Answer


def judge_accuracies(
    truth: Truth,
    integrator: Integrator,
    sweeps: Iterable[Sweep],
    result: CaseResult,
    finer: Iterable[tuple[Sweep, Answer]],
) -> Iterator[JudgedRun]:
    """Judge every accuracy of one integrator; finer ones serve to see whether its error follows."""
    answers = [(sweep, result.runs[integrator.name, sweep.knob]) for sweep in sweeps]
    eps, measure_one = truth.yardstick.eps, partial(accuracy.measure_accuracy, truth, integrator)
    measured_runs = measured_runs_of(measure_one, [*answers, *finer])
    known = list(measured_runs.values())
    further = accuracy_followed.finer_sweep(truth, integrator, known) if known else None
    for sweep, answer in answers:
        measured = measured_runs.get(sweep)
        if measured is None:
            yield failed(integrator, sweep, answer, eps)
            continue
        findings = accuracy_followed.findings_of(measured, known)
        if not is_finite(State(**answer.result["state"])):
            yield diverged(integrator, sweep, answer, measured, findings, eps)
            continue
        rows, broken = rows_with_probes(truth, integrator, measured, findings, answer, result)
        why = broken[0] if broken else why_of(findings)
        rows = [*accuracy_followed.rows(measured, known), *rows]
        unresolved = not broken and further is not None
        yield JudgedRun(integrator, sweep, "ok", "", rows, why, unresolved, further)
