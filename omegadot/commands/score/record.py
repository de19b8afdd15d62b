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
from omegadot.commands.score.own_units import in_own_unit
from omegadot.gates.rows import Row, worst
from omegadot.harness.collect import COLUMNS
from omegadot.harness.outcome import JudgedCase, Outcome, RunRequest
from omegadot.harness.plan import EngineChoice
from omegadot.reference_impl.system import Array
from omegadot.reports.record import schema
from omegadot.reports.record.record import Record
from omegadot.reports.summary.headline import headline
from omegadot.reports.summary.summary import summarise
from omegadot.written import written

FIELDS = {**COLUMNS, "omega_dot": ("ax", "ay", "az")}


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
    alone = Outcome([], [], [JudgedCase(found.case, found.truth, "", [])], False, [])
    outcome = execute(request, report) if choices else alone
    base = record_of(outcome, request, command, time.perf_counter() - started)
    labels = {
        "scenario": found.case.name,
        "engine": name,
        "setup": "physics",
        "integrator": found.scheme or "as-given",
        "timestep": found.declared.timestep if found.declared else None,
        "accuracy": None,
    }
    # The beginning of the file's SHA-256: traces of one name are distinguished by it.
    content = Path(found.reading.table.file).read_bytes()
    task = {**labels, "engine_version": hashlib.sha256(content).hexdigest()[:8]}
    base.run["engines"].append(_engine(found, task))
    gates = {gate: worst(row.verdict for row in rows if row.gate == gate) for gate in schema.GATES}
    base.run["tasks"].append(
        {
            **task,
            "outcome": "ok",
            "reason": "",
            "gates": {gate: verdict for gate, verdict in gates.items() if verdict is not None},
            "why": _why(found, rows),
            "scheme": found.scheme,
        }
    )
    columns = {key: f.dtype for key, f in schema.METRICS.items()}
    entries = [{**task, **vars(row)} for row in rows]
    metrics = pl.DataFrame(entries, schema=columns, orient="row").select(list(columns))
    trajectories = _trajectories(base.trajectories, found, labels)
    record = Record(base.run, pl.concat([base.metrics, metrics]), trajectories)
    engines = [headline(summarise(record))] if choices else []
    record.run["headline"] = " ".join([_sentence(found, rows, name), *engines])
    return record


def _conventions(how: Convention) -> list[str]:
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


def _engine(found: Judged, task: dict[str, Any]) -> dict[str, Any]:
    note = "a trace from outside; its scheme is " + ("" if found.scheme else "not ") + "declared"
    integrator = {
        "name": task["integrator"], "scheme": found.scheme, "orders": {}, "knob": "timestep",
        "note": note, "coordinates": "com-world",
    }  # fmt: skip
    return {
        "name": task["engine"],
        "version": task["engine_version"],
        "installed": True,
        "reason": "",
        "integrators": [integrator],
        "precision": "float64",
        "conventions": _conventions(found.reading.how),
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


def _why(found: Judged, rows: list[Row]) -> str:
    """One reason for the whole trace: a failure's, that it is late, or its worst channel's."""
    reasons = [f"{row.channel}: {row.note}" for row in rows if row.verdict == "fail"]
    if found.shift and found.shift.explains:
        reasons.append(found.shift.as_text)
    unlike = {c: one.note for c, one in found.judgement.items() if one.kind != "round-off"}
    reasons += [f"{channel}: {note}" for channel, note in unlike.items()]
    return reasons[0] if reasons else "within digits and rounding"


def _sentence(found: Judged, rows: list[Row], name: str) -> str:
    """The trace in one sentence, for the top of the page."""
    for row in rows:
        if row.verdict == "fail":
            return f"{name} fails on {found.case.name}: {row.channel}, {row.note}."
    parts = []
    for channel in found.error:
        score = in_own_unit(found, channel)
        unit = "" if score.unit == "relative" else f" {score.unit}"
        parts.append(f"{channel.replace('_', ' ')} by {written(score.max, 3)}{unit}")
    late = found.shift.as_text if found.shift and found.shift.explains else ""
    why = f" It is {late}, and that is its error." if late else ""
    return f"{name} on {found.case.name} is off at most: {', '.join(parts[:3])}.{why}"


def _trajectories(known: pl.DataFrame, found: Judged, labels: dict[str, Any]) -> pl.DataFrame:
    """The trace, NaN where it gives nothing, and the exact trajectory at its times."""
    trace, truth = found.trace, found.truth
    exact = {**labels, "engine": "exact", "integrator": truth.source, "timestep": None}
    sampled = _samples(exact, trace.times, {**vars(truth.state), "omega_dot": truth.omega_dot})
    at_known = known.filter(pl.col("engine") == "exact").get_column("time").implode()
    sampled = sampled.filter(~pl.col("time").is_in(at_known))
    return pl.concat([known, sampled, _samples(labels, trace.times, vars(trace))])


def _samples(labels: dict[str, Any], times: Array, parts: dict[str, Any]) -> pl.DataFrame:
    columns = {"time": times}
    for field, names in FIELDS.items():
        values = np.full((len(times), len(names)), np.nan) if parts[field] is None else parts[field]
        columns |= {n: np.ascontiguousarray(values[:, i]) for i, n in enumerate(names)}
    texts = [pl.lit(v, dtype=schema.TRAJECTORIES[k].dtype).alias(k) for k, v in labels.items()]
    return pl.DataFrame(columns).with_columns(texts).select(list(schema.TRAJECTORIES))
