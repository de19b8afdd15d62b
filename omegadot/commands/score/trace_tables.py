"""A scored trace in the record's tables."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import polars as pl

from omegadot.commands.score.judged import Judged
from omegadot.gates.rows import Row
from omegadot.harness.collect import COLUMNS
from omegadot.reference_impl.system import Array, State
from omegadot.reports.record import schema

SETUP = "physics"
UNDECLARED = "as-given"


def labels_of(found: Judged, name: str) -> dict[str, Any]:
    """What names the trace's task in the tables."""
    scheme, timestep = UNDECLARED, None
    if found.declared is not None:
        scheme, timestep = found.declared.scheme or UNDECLARED, found.declared.timestep
    return {
        "scenario": found.case.name,
        "engine": name,
        "setup": SETUP,
        "integrator": scheme,
        "timestep": timestep,
        "accuracy": None,
    }


def metrics_of(labels: dict[str, Any], version: str, rows: list[Row]) -> pl.DataFrame:
    """The rows as the contract's table."""
    columns = {name: f.dtype for name, f in schema.METRICS.items()}
    entries = [{**labels, "engine_version": version, **vars(row)} for row in rows]
    return pl.DataFrame(entries, schema=columns, orient="row").select(list(columns))


def _samples(labels: dict[str, Any], times: Array, parts: dict[str, Array]) -> pl.DataFrame:
    columns = {"time": times}
    for field, names in {**COLUMNS, "omega_dot": ("ax", "ay", "az")}.items():
        columns |= {n: np.ascontiguousarray(parts[field][:, i]) for i, n in enumerate(names)}
    texts = [pl.lit(v, dtype=schema.TRAJECTORIES[k].dtype).alias(k) for k, v in labels.items()]
    return pl.DataFrame(columns).with_columns(texts).select(list(schema.TRAJECTORIES))


def trajectories_of(known: pl.DataFrame, found: Judged, labels: dict[str, Any]) -> pl.DataFrame:
    """The trace, NaN where it gives nothing, and the exact trajectory at its times."""
    times, truth = found.trace.times, found.truth
    exact = {**labels, "engine": "exact", "integrator": truth.source, "timestep": None}
    parts = {**vars(truth.state), "omega_dot": truth.omega_dot}
    sampled = _samples(exact, times, parts)
    at_known = known.filter(pl.col("engine") == "exact").get_column("time").implode()
    sampled = sampled.filter(~pl.col("time").is_in(at_known))
    return pl.concat([known, sampled, _samples(labels, times, _given(found))])


def _given(found: Judged) -> dict[str, Array]:
    trace, count = found.trace, len(found.trace.times)
    fields = [field.name for field in dataclasses.fields(State)]
    given = {field: getattr(trace, field) for field in (*fields, "omega_dot")}
    size = {"orientation": 4}
    return {
        field: np.full((count, size.get(field, 3)), np.nan) if value is None else value
        for field, value in given.items()
    }
