"""The failing engines of a record, each with what is stated of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import polars as pl

from omegadot.reports.record.record import Record
from omegadot.reports.record.schema import GATES
from omegadot.reports.summary.cost import WHO, cost_of
from omegadot.reports.summary.engine_failure import EngineFailure
from omegadot.reports.summary.failed_gate import measure, worst_row
from omegadot.reports.summary.holding import facts, scope
from omegadot.reports.summary.next_command import next_command
from omegadot.reports.summary.reasons import cause_of, failing_gates
from omegadot.reports.summary.unseen import OF_STEPS, unseen
from omegadot.reports.text.numbers import engine_name, knob, listed, times

UNKNOWN = "none is known"
STEPLESS = ("model", "equation")
EITHER = "either "  # begins a cause that is one of several
# One cell run alone may leave open what all scenarios together decide.
UNDECIDED = " (each of these fits all that failed here; more scenarios may exclude some)"
Row = Mapping[str, Any]


def failures_of(record: Record) -> tuple[EngineFailure, ...]:
    """Every failing engine, the dearest first; those that cost the same in the record's order."""
    rows = record.metrics.filter(pl.col("verdict") == "fail").to_dicts()
    several = Counter(name for name, *_ in {tuple(row[key] for key in WHO) for row in rows})
    found: dict[tuple[str, ...], list[Row]] = {}
    for row in rows:
        found.setdefault(tuple(row[key] for key in WHO), []).append(row)
    failures = []
    for who, own in found.items():
        engine, version, setup = who
        tasks = [task for task in record.run["tasks"] if task["engine"] == engine]
        failing, worst = list(filter(failing_gates, tasks)), worst_row(own)
        at_gate = [task for task in failing if worst["gate"] in failing_gates(task)]
        places = {row["scenario"] for row in own if row["gate"] == worst["gate"]}
        places |= {task["scenario"] for task in at_gate}
        every = _rows_of(record, who).to_dicts() if worst["gate"] == "equation" else []
        others = {row["gate"] for row in own} | {g for t in failing for g in failing_gates(t)}
        cause, cost = _likeliest(failing), cost_of(record, who, own)
        failures.append(
            EngineFailure(
                engine_name(engine, version if several[engine] > 1 else "", setup),
                worst["gate"],
                worst["scenario"],
                _run(worst, tasks, at_gate),
                measure(worst),
                worst["gate"] in STEPLESS,
                (len(places), len({task["scenario"] for task in tasks})),
                (_count(at_gate, worst), _count(tasks, worst)),
                cause,
                cost.text,
                unseen(record, worst, every, at_gate),
                tuple(g for g in GATES if g in others and GATES.index(g) > _place(worst)),
                _seen(failing) or ("" if cause else facts(own, tasks, worst["gate"])),
                next_command(record.run, worst, {task["integrator"] for task in failing}),
                scope(record.run, tasks, worst, sorted(places)),
                who,
                cost.size,
            )
        )
    return tuple(sorted(failures, key=lambda failure: -failure.harm))


def _count(tasks: Sequence[Row], worst: Row) -> int:
    return sum(1 for task in tasks if task["scenario"] == worst["scenario"] and task["integrator"])


def _rows_of(record: Record, who: tuple[str, ...]) -> pl.DataFrame:
    """The rows of the equation gate of an engine, whatever their verdict."""
    same = (pl.col(key).eq_missing(value) for key, value in zip(WHO, who, strict=True))
    return record.metrics.filter(pl.col("gate") == "equation", *same)


def _place(row: Row) -> int:
    return GATES.index(row["gate"])


def _run(worst: Row, tasks: Sequence[Row], failing: Sequence[Row]) -> str:
    """The run of the worst measure; where integrators share it, those whose runs fail."""
    if worst["integrator"] and worst["metric"] != OF_STEPS:  # which has steps of its own
        return ", ".join(filter(None, (worst["integrator"], knob(worst["timestep"], None))))
    here = [task for task in tasks if task["scenario"] == worst["scenario"] and task["integrator"]]
    names = dict.fromkeys(task["integrator"] for task in failing if task in here)
    if len(names) > 1 and len(names) == len({task["integrator"] for task in here}):
        return "every integrator"
    return listed(list(names)) if names else ""


def _likeliest(failing: Sequence[Row]) -> str:
    """The cause that explains most runs, with how many others there are."""
    causes = Counter(filter(None, map(cause_of, failing)))
    known = [(cause, n) for cause, n in causes.most_common() if not cause.startswith(UNKNOWN)]
    if not known:
        return ""
    more = f"; {times(len(known) - 1, 'other cause')} elsewhere" if len(known) > 1 else ""
    cause = known[0][0].rstrip(".")
    return f"{cause}{UNDECIDED if cause.startswith(EITHER) else ''}{more}"


def _seen(failing: Sequence[Row]) -> str:
    """Where no cause is found of any run, what is known of the most runs in its place."""
    texts = Counter(filter(None, map(cause_of, failing)))
    if not texts or any(not text.startswith(UNKNOWN) for text in texts):
        return ""
    text = texts.most_common(1)[0][0].removeprefix(UNKNOWN)
    return text.lstrip("; ").rstrip(".")
