"""From one engine's judged case to the results of its checks, each failure as a sentence."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Sequence
from functools import partial

from omegadot.commands.check.result import (
    GATES_OF_A_RUN,
    GATES_OF_A_SCENARIO,
    PASSED,
    Check,
    Result,
    error,
    skipped,
)
from omegadot.gates.case import knobs_of
from omegadot.gates.rows import Row, worst
from omegadot.gates.runs import repeats
from omegadot.gates.runs.exact import exact_rows
from omegadot.harness.judging.judged_run import JudgedRun
from omegadot.harness.outcome import Cause, EngineCase, JudgedCase
from omegadot.reports.summary.plain import is_plain
from omegadot.reports.text.numbers import degrees, listed, short, times_its_bound
from omegadot.workers.harness_end.process import Answer

CAUSE = "Likely cause: "
# Their notes are the whole sentence, with the figures in it.
NOTE_ALONE = ("match", "observed_order", "sample_times")
# For these the note is clearer than the figure, a fraction of its bound.
NOTE_BEFORE_FIGURE = ("restarted", "rate_at_no_step", "start", "precision", *repeats.NOTES)


def _excess(row: Row) -> float:
    """For ordering alone: what a note states comes after what is measured."""
    return 0.0 if row.metric in NOTE_ALONE else times_its_bound(row.value, row.bound)


# As a reader would say it; the others are their names without underscores.
METRICS = {
    "error_max": "largest error",
    "drift_quarter": "drift after a quarter of the run",
    "drift_half": "drift after half of the run",
    "drift_full": "drift after the whole run",
    "residual_on_path": "residual along the exact motion",
    "residual_in_run": "residual along the run",
    "residual_of_sibling": "residual",  # the note names the sibling
    "residual_reloaded": "residual",
    "residual_alone": "residual",
}


def _unit(row: Row) -> str:
    return "" if row.unit == "1" else f" {row.unit}"


def _degrees(row: Row) -> str:
    finite = row.unit == "rad" and math.isfinite(row.value)
    return f" ({degrees(row.value)} deg)" if finite else ""


def sentence(row: Row) -> str:
    """One failing row as text."""
    if row.metric in (*NOTE_ALONE, *NOTE_BEFORE_FIGURE) and row.note:
        return f"{row.channel}: {row.note}"
    metric = METRICS.get(row.metric, row.metric.replace("_", " "))
    message = f"{row.channel}: {metric} is {short(row.value, 3)}{_unit(row)}{_degrees(row)}"
    if row.bound is not None:
        excess, bound = times_its_bound(row.value, row.bound), f"{short(row.bound)}{_unit(row)}"
        times = f"{short(excess)} times " if math.isfinite(excess) else "above "
        message += f", {times}its bound of {bound}"
    return f"{message} ({row.note})" if row.note else message


def _worst(failing: Sequence[Row]) -> Row:
    return max([row for row in failing if is_plain(row.metric)] or failing, key=_excess)


def _times(rows: Sequence[Row]) -> float | None:
    """How many times its bound the worst of the failing rows is; None where that is no number."""
    row = _worst([row for row in rows if row.verdict == "fail"])
    excess = times_its_bound(row.value, row.bound)
    return excess if row.bound is not None and math.isfinite(excess) else None


def failure(rows: Sequence[Row], cause: str = "") -> str:
    """The failing rows of one gate: the worst in full, the other channels by name."""
    failing = [row for row in rows if row.verdict == "fail"]
    worst = _worst(failing)
    others = dict.fromkeys(row.channel for row in failing if row.channel != worst.channel)
    message = sentence(worst)
    if others:
        message += f"; {listed(list(others))} {'fail' if len(others) > 1 else 'fails'} as well"
    return f"{message}. {CAUSE}{cause.rstrip('.')}." if cause else f"{message}."


def to_read(message: str) -> str:
    """The message without its cause where the sentence before has stated it word for word."""
    stated, _, cause = message.partition(CAUSE)
    clause = rf"(^|[:;.(] ?){re.escape(cause.rstrip('.'))}($|[;.)])"
    return stated.rstrip() if cause and re.search(clause, stated.rstrip()) else message


# The answers, besides runs, that a gate of a scenario judges.
REQUESTED = {
    "model": ("model",),
    "equation": ("forward", "path", "inverse", "alone", "inverse_alone", "reloaded"),
}
MEASURED = ("ok", "diverged")


def _of_rows(rows: Sequence[Row], cause: Callable[[], str], unjudged: str) -> Result:
    verdict = worst(row.verdict for row in rows)
    if verdict == "fail":
        again = partial(_explained, rows, cause)
        return Result("fail", failure(rows), excess=_times(rows), explained=again)
    if verdict == "pass":
        return PASSED
    notes = dict.fromkeys(row.note for row in rows if row.note)
    note = next(iter(notes), unjudged)
    return skipped(_unjudged(note))


def _explained(rows: Sequence[Row], cause: Callable[[], str]) -> str:
    return failure(rows, cause())


def _unjudged(note: str) -> str:
    return f"not judged: {note.removeprefix('not judged: ')}"


def _of_scenario(found: EngineCase, gate: str, cause: Callable[[], str]) -> Result:
    answers: list[Answer] = [getattr(found.result, name) for name in REQUESTED[gate]]
    if gate == "equation":
        answers += [answer for *_, answer in found.result.siblings.values()]
    for answer in answers:
        if answer.outcome not in ("ok", "unsupported"):
            return error(answer.outcome, answer.reason)
    if not any(answer.ok for answer in answers):
        return skipped(f"unsupported: {answers[0].reason}")
    rows = [row for row in found.shared if row.gate == gate]
    return _of_rows(rows, cause, "the engine gave nothing to judge")


def _of_run(run: JudgedRun, gate: str, cause: Callable[[], str]) -> Result:
    if run.outcome == "unsupported":
        return skipped(f"unsupported: {run.reason}")
    if run.outcome not in MEASURED:
        return error(run.outcome, run.reason)
    rows = [row for row in run.rows if row.gate == gate]
    if not rows:
        return skipped(_unjudged(run.why or "there is nothing to measure"))
    return _of_rows(rows, cause, run.why)


def _refuses_the_step(run: JudgedRun, runs: Sequence[JudgedRun]) -> bool:
    """Whether an integrator raises at a step, and runs at a finer one of the same sweep.

    An implicit step's equation need not have a solution where the step is long.
    """
    return run.outcome == "raised" and any(
        other.integrator.name == run.integrator.name
        and other.sweep.knob < run.sweep.knob
        and other.outcome == "ok"
        for other in runs
    )


def results_of(
    judged: JudgedCase, found: EngineCase, cause: Cause, *, drawn: bool = False
) -> Iterator[tuple[Check, Result]]:
    """The results of every check of one engine on one case; none without an exact trajectory.

    cause: called only where a check fails; "" where no cause is found.  drawn: the steps are those
    of a system that was drawn, not named; one that an engine refuses is skipped.
    """
    name, case = found.engine.name, judged.case
    if judged.truth is None:
        return
    for gate in GATES_OF_A_SCENARIO:
        check = Check(name, case.name, gate)
        yield check, _of_scenario(found, gate, partial(cause, None))
    if name == "exact":
        rows = [row for row in exact_rows(case, judged.truth) if row.gate == "invariants"]
        why = "nothing is constant under this load"
        yield Check(name, case.name, "invariants"), _of_rows(rows, lambda: "", why)
    for run in found.runs:
        refused = drawn and _refuses_the_step(run, found.runs)
        for gate in GATES_OF_A_RUN:
            check = Check(name, case.name, gate, run.integrator.name, **knobs_of(run.sweep))
            if refused:
                yield check, skipped(f"raised at this step and at no finer one: {run.reason}")
            else:
                yield check, _of_run(run, gate, partial(cause, run))
