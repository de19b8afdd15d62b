"""The rows of one run, with those of what was requested beside it: probes, and the run again."""

from __future__ import annotations

from collections.abc import Sequence

from omegadot.adapters.protocol import Integrator
from omegadot.gates.errors.measured_run import MeasuredRun
from omegadot.gates.errors.verdicts import Finding
from omegadot.gates.rows import Row
from omegadot.gates.truth import Truth
from omegadot.harness.drive import CaseResult
from omegadot.harness.judging.judged_run import rows_of_run
from omegadot.harness.requests.repeats import rows_again
from omegadot.harness.requests.step_probes import rows_of_probes
from omegadot.workers.harness_end.process import Answer


def rows_with_probes(
    truth: Truth,
    integrator: Integrator,
    measured: MeasuredRun,
    findings: dict[str, Finding],
    answer: Answer,
    result: CaseResult,
    broken: Sequence[str] = (),
) -> tuple[list[Row], list[str]]:
    """Those of a run, whatever its knob, and the notes of what is broken in it.

    broken: notes of the same kind, which stand after what the run misreports.
    """
    sweep = measured.sweep
    probed = rows_of_probes(truth, integrator, sweep, result)
    probed += rows_again(truth, integrator, sweep, result, measured)
    rows, misreported = rows_of_run(truth, measured, findings, answer, result)
    failed = [row.note for row in probed if row.verdict == "fail"]
    return [*probed, *rows], [*misreported, *broken, *failed]
