"""The page scenario by scenario: what each section shows and draws."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import polars as pl

from omegadot.reference_impl.system import Array
from omegadot.reports.charts.bounds import (
    Limits,
    Residual,
    floor_of,
    limits_of,
    residuals_of,
)
from omegadot.reports.charts.deviations import Chart
from omegadot.reports.charts.diagrams import engines_drawn, equation_payload, front_payload
from omegadot.reports.charts.front import FrontPoint, named, pareto_front
from omegadot.reports.charts.payload import Line, payload
from omegadot.reports.charts.sweeps import Sweep, sweeps_of
from omegadot.reports.page import tables
from omegadot.reports.record.record import Record
from omegadot.reports.summary import matrix
from omegadot.reports.summary.clusters import on_scenario
from omegadot.reports.summary.provenance import Sources
from omegadot.reports.summary.summary import Summary


@dataclass(frozen=True)
class Section:
    """One scenario of the page. anchor: its address within the page, safe whatever its name."""

    anchor: str
    name: str
    title: str
    shows: str
    source: str
    definition: str
    lines: list[matrix.Line]
    chart: Chart | None
    deviations: tables.Table | None
    clusters: str
    residuals: list[Residual]
    front: list[tuple[str, str]]
    engines: tables.Table
    runs: tables.Table


@dataclass(frozen=True)
class Measured:
    """What the charts draw besides the errors, by scenario."""

    limits: Mapping[str, Limits]
    sweeps: Mapping[str, list[Sweep]]
    residuals: Mapping[str, list[Residual]]
    fronts: Mapping[str, list[FrontPoint]]


def measured_in(metrics: pl.DataFrame) -> Measured:
    """Read from the measures once, for all sections.

    A Pareto front is one of cost and attitude error, above the floor.
    """
    limits, sweeps, none = limits_of(metrics), sweeps_of(metrics), Limits({}, {})
    fronts = {n: pareto_front(own, floor_of(limits.get(n, none))) for n, own in sweeps.items()}
    return Measured(limits, sweeps, residuals_of(metrics), fronts)


def sections_of(
    record: Record,
    summary: Summary,
    charts: Mapping[str, Chart],
    anchors: Mapping[str, str],
    sources: Sources,
    measured: Measured,
) -> list[Section]:
    """Every scenario's section, in the order of the matrix."""
    entries = {entry["name"]: entry for entry in record.run["scenarios"]}
    metrics = record.metrics.partition_by("scenario", as_dict=True)
    sections = []
    for name in summary.scenarios:
        entry, chart = entries.get(name, {}), charts.get(name)
        own = metrics.get((name,), record.metrics.clear())
        tasks = [task for task in record.run["tasks"] if task["scenario"] == name]
        sections.append(
            Section(
                anchors[name],
                name,
                entry.get("title") or name,
                entry.get("shows") or "",
                entry.get("source") or "",
                json.dumps(entry.get("definition") or {}, indent=1, ensure_ascii=False),
                matrix.lines(summary, name, sources),
                chart,
                tables.deviation_table(chart, sources) if chart else None,
                on_scenario(record.run, name),
                measured.residuals.get(name, []),
                [named(point) for point in measured.fronts.get(name, [])],
                tables.engine_table(own, sources),
                tables.run_table(own, tasks, sources),
            )
        )
    return sections


def drawings(
    measured: Measured,
    charts: Mapping[str, Chart],
    lines: list[Line],
    anchors: Mapping[str, str],
    sources: Sources,
) -> tuple[dict[str, Any], Array]:
    """What the page's script draws, by the scenarios' addresses."""
    description, codes = payload(charts, measured.sweeps, lines, measured.limits, sources)
    engines = engines_drawn(lines, measured.residuals)
    for name, drawn in description["scenarios"].items():
        drawn["equation"] = equation_payload(measured.residuals.get(name, []), sources, engines)
        drawn["front"] = front_payload(measured.fronts.get(name, []))
    by_address = {anchors[name]: drawn for name, drawn in description["scenarios"].items()}
    return {**description, "scenarios": by_address}, codes
