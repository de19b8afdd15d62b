"""From one engine's judged case to the results of its checks."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial

from omegadot.commands.check.generate import GATES_OF_A_RUN, GATES_OF_A_SCENARIO
from omegadot.commands.check.message import failure
from omegadot.commands.check.result import PASSED, Check, Result, error, skipped
from omegadot.gates.exact import exact_rows
from omegadot.gates.rows import Row, worst
from omegadot.harness.judge import JudgedRun
from omegadot.harness.outcome import Cause, EngineCase, JudgedCase
from omegadot.workers.harness_end.process import Answer

# The answers, besides runs, that a gate of a scenario judges.
REQUESTED = {"model": ("model",), "equation": ("forward", "path", "inverse")}
MEASURED = ("ok", "diverged")


def _of_rows(rows: Sequence[Row], cause: Callable[[], str], unjudged: str) -> Result:
    verdict = worst(row.verdict for row in rows)
    if verdict == "fail":
        return Result("fail", failure(rows, cause()))
    if verdict == "pass":
        return PASSED
    notes = dict.fromkeys(row.note for row in rows if row.note)
    return skipped(f"not judged: {next(iter(notes), unjudged)}")


def _answered(answers: Sequence[Answer]) -> Result | None:
    """The first answer that is a failure, or the refusal where every answer is one."""
    for answer in answers:
        if answer.outcome not in ("ok", "unsupported"):
            return error(answer.outcome, answer.reason)
    refused = [answer for answer in answers if answer.outcome == "unsupported"]
    if len(refused) == len(answers):
        return skipped(f"unsupported: {refused[0].reason}")
    return None


def _of_scenario(found: EngineCase, gate: str, cause: Callable[[], str]) -> Result:
    answers = [getattr(found.result, name) for name in REQUESTED[gate]]
    refused = _answered(answers)
    if refused is not None:
        return refused
    rows = [row for row in found.shared if row.gate == gate]
    return _of_rows(rows, cause, "the engine gave nothing to judge")


def _of_run(run: JudgedRun, gate: str, cause: Callable[[], str]) -> Result:
    if run.outcome == "unsupported":
        return skipped(f"unsupported: {run.reason}")
    if run.outcome not in MEASURED:
        return error(run.outcome, run.reason)
    rows = [row for row in run.rows if row.gate == gate]
    if not rows:
        return skipped(f"not judged: {run.why or 'there is nothing to measure'}")
    return _of_rows(rows, cause, run.why)


def _judgements(
    judged: JudgedCase, found: EngineCase, cause: Cause
) -> Iterator[tuple[Check, Result]]:
    name, case = found.engine.name, judged.case
    for gate in GATES_OF_A_SCENARIO:
        check = Check(name, case.name, gate)
        yield check, _of_scenario(found, gate, partial(cause, None))
    if name == "exact" and judged.truth is not None:
        rows = [row for row in exact_rows(case, judged.truth) if row.gate == "invariants"]
        why = "nothing is constant under this load"
        yield Check(name, case.name, "invariants"), _of_rows(rows, lambda: "", why)
    for run in found.runs:
        for gate in GATES_OF_A_RUN:
            check = Check(name, case.name, gate, run.integrator.name, run.sweep.timestep)
            yield check, _of_run(run, gate, partial(cause, run))


def results_of(judged: JudgedCase, found: EngineCase, cause: Cause) -> dict[Check, Result]:
    """The results of every check of one engine on one case; none without an exact trajectory.

    cause: called only where a check fails; "" where no cause is found.
    """
    return {} if judged.truth is None else dict(_judgements(judged, found, cause))
