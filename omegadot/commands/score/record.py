"""A scored trace as a record: the trace takes an engine's place, next to engines that are run."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

from omegadot.commands.progress import Reporter
from omegadot.commands.run.record import record_of
from omegadot.commands.run.run import execute
from omegadot.commands.score.convention import Convention, axes_text
from omegadot.commands.score.judged import Judged
from omegadot.commands.score.sentences import largest
from omegadot.commands.score.trace_tables import labels_of, metrics_of, trajectories_of
from omegadot.gates.rows import Row, worst
from omegadot.harness.outcome import JudgedCase, Outcome, RunRequest
from omegadot.harness.plan import EngineChoice
from omegadot.reports.record import schema
from omegadot.reports.record.record import Record
from omegadot.reports.summary.headline import headline
from omegadot.reports.summary.summary import summarise


def scored_record(
    found: Judged,
    rows: list[Row],
    name: str,
    choices: Sequence[EngineChoice],
    command: Sequence[str],
    report: Reporter,
) -> Record:
    """The record of the trace and of the engines that are run with it."""
    started = time.perf_counter()
    request = RunRequest([found.case], list(choices))
    outcome = execute(request, report) if choices else _alone(found)
    base = record_of(outcome, request, command, time.perf_counter() - started)
    base.run["engines"].append(_engine(found, name))
    base.run["tasks"].append(_task(found, rows, name))
    labels = labels_of(found, name)
    record = Record(
        base.run,
        pl.concat([base.metrics, metrics_of(labels, version_of(found), rows)]),
        trajectories_of(base.trajectories, found, labels),
    )
    engines = [headline(summarise(record))] if choices else []
    record.run["headline"] = " ".join([sentence_of(found, rows, name), *engines])
    return record


def _alone(found: Judged) -> Outcome:
    return Outcome([], [], [JudgedCase(found.case, found.truth, "", [])], False, [])


def version_of(found: Judged) -> str:
    """The beginning of the file's SHA-256: traces of one name are distinguished by it."""
    return hashlib.sha256(Path(found.reading.table.file).read_bytes()).hexdigest()[:8]


def conventions_of(how: Convention) -> list[str]:
    """How the trace was read, one clause each."""
    clauses = [
        f"time in {how.time_unit}, angles in {how.angle_unit}, rates in {how.rate_unit}, "
        f"lengths in {how.length_unit}",
        f"omega in {how.omega_frame} axes, attitude {how.attitude_is}",
    ]
    for kind, axes in (("world", how.world_axes), ("body", how.body_axes)):
        if not np.array_equal(axes, np.eye(3)):
            exact = bool(np.all(np.isin(axes, (-1.0, 0.0, 1.0))))
            clauses.append(f"{kind} axes turned" + (f": {axes_text(axes)}" if exact else ""))
    return clauses


def _engine(found: Judged, name: str) -> dict[str, Any]:
    labels = labels_of(found, name)
    scheme = found.declared.scheme if found.declared else None
    note = "a trace from outside; its scheme is " + ("declared" if scheme else "not declared")
    integrator = {
        "name": labels["integrator"], "scheme": scheme, "orders": {}, "knob": "timestep",
        "note": note, "coordinates": "com-world",
    }  # fmt: skip
    return {
        "name": name,
        "version": version_of(found),
        "installed": True,
        "reason": "",
        "integrators": [integrator],
        "precision": "float64",
        "conventions": conventions_of(found.reading.how),
        "switched_off": [],
        "features": [],
        "licence": "",
        "links": [],
        "trace": {
            "file": found.reading.table.file,
            "columns": found.reading.columns,
            "samples": len(found.trace.times),
        },
    }


def gates_of(rows: list[Row]) -> dict[str, str]:
    """The worst verdict of every gate that has a row."""
    verdicts = {g: worst(row.verdict for row in rows if row.gate == g) for g in schema.GATES}
    return {gate: verdict for gate, verdict in verdicts.items() if verdict is not None}


def why_of(found: Judged, rows: list[Row]) -> str:
    """One reason for the whole trace: a failure's, that it is late, or its worst channel's."""
    failed = [row for row in rows if row.verdict == "fail"]
    if failed:
        return f"{failed[0].channel}: {failed[0].note}"
    if found.shift is not None and found.shift.explains:
        return found.shift.as_text
    unlike = [
        (c, judgement) for c, judgement in found.judgement.items() if judgement.kind != "round-off"
    ]
    return f"{unlike[0][0]}: {unlike[0][1].note}" if unlike else "within digits and rounding"


def sentence_of(found: Judged, rows: list[Row], name: str) -> str:
    """The trace in one sentence, for the top of the page."""
    failed = [row for row in rows if row.verdict == "fail"]
    if failed:
        return f"{name} fails on {found.case.name}: {failed[0].channel}, {failed[0].note}."
    parts = [f"{channel.replace('_', ' ')} by {largest(found, channel)}" for channel in found.error]
    late = found.shift is not None and found.shift.explains
    why = f" It is {found.shift.as_text}, and that is its error." if late and found.shift else ""
    return f"{name} on {found.case.name} is off at most: {', '.join(parts[:3])}.{why}"


def _task(found: Judged, rows: list[Row], name: str) -> dict[str, Any]:
    return {
        **labels_of(found, name),
        "engine_version": version_of(found),
        "outcome": "ok",
        "reason": "",
        "gates": gates_of(rows),
        "why": why_of(found, rows),
        "scheme": found.declared.scheme if found.declared else None,
    }
