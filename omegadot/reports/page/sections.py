"""The page scenario by scenario: what each section shows and draws."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import polars as pl

from omegadot.reference_impl.system import Array
from omegadot.reports.charts.bounds import Limits, Residual, floor_of, limits_of, residuals_of
from omegadot.reports.charts.coinciding import Lane
from omegadot.reports.charts.deviations import Chart
from omegadot.reports.charts.front import FrontPoint, named, pareto_front
from omegadot.reports.charts.packing import rounded
from omegadot.reports.charts.palette import Line
from omegadot.reports.charts.payload import equation_payload, payload
from omegadot.reports.charts.still import stills
from omegadot.reports.charts.sweeps import Sweep, sweeps_of
from omegadot.reports.page import tables
from omegadot.reports.record.record import Record
from omegadot.reports.summary import matrix
from omegadot.reports.summary.cluster_sentences import on_scenario
from omegadot.reports.summary.provenance import Sources
from omegadot.reports.summary.summary import Summary, worst


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
    limits, sweeps, none = limits_of(metrics), sweeps_of(metrics), Limits()
    fronts = {n: pareto_front(own, floor_of(limits.get(n, none))) for n, own in sweeps.items()}
    return Measured(limits, sweeps, residuals_of(metrics), fronts)


def sections_of(
    record: Record,
    summary: Summary,
    charts: Mapping[str, Chart],
    anchors: Mapping[str, str],
    sources: Sources,
    measured: Measured,
    drawn: Mapping[str, Any],
) -> Iterator[dict[str, Any]]:
    """What the template takes of every scenario, in the order of the matrix.

    anchor: its address within the page, safe whatever its name.  drawn: by address, what the
    script draws.
    """
    entries = {entry["name"]: entry for entry in record.run["scenarios"]}
    metrics = record.metrics.partition_by("scenario", as_dict=True)
    for name in summary.scenarios:
        entry, chart = entries.get(name, {}), charts.get(name)
        own = metrics.get((name,), record.metrics.clear())
        tasks = [task for task in record.run["tasks"] if task["scenario"] == name]
        status = worst(summary.cells[name, column].status for column in summary.columns)
        on_page = drawn.get(anchors[name], {})
        yield {
            "anchor": anchors[name],
            "name": name,
            "status": status,
            "mark": matrix.MARKS.get(status, "–"),
            "title": entry.get("title") or name,
            "shows": entry.get("shows"),
            "source": entry.get("source"),
            "definition": json.dumps(entry.get("definition") or {}, indent=1, ensure_ascii=False),
            "lines": matrix.lines(summary, name, sources),
            "chart": chart,
            "deviations": tables.deviation_table(chart, sources) if chart else None,
            "stills": stills(chart, on_page) if chart else {},
            "steps": on_page["steps"] if chart else [],
            "floors": tables.floors_text(own),
            "clusters": on_scenario(record.run, name),
            "residuals": measured.residuals.get(name, []),
            "front": [named(point) for point in measured.fronts.get(name, [])],
            "engines": tables.engine_table(own, sources),
            "runs": tables.run_table(own, tasks, sources),
        }


def failing_lanes(metrics: pl.DataFrame) -> dict[str, set[Lane]]:
    """By scenario: the integrators of which a gate fails."""
    failed = metrics.filter((pl.col("verdict") == "fail") & pl.col("integrator").is_not_null())
    found: dict[str, set[Lane]] = {}
    for scenario, *lane in (
        failed.select("scenario", "engine", "setup", "integrator").unique().iter_rows()
    ):
        found.setdefault(scenario, set()).add((lane[0], lane[1], lane[2]))
    return found


def drawings(
    measured: Measured,
    charts: Mapping[str, Chart],
    lines: list[Line],
    anchors: Mapping[str, str],
    sources: Sources,
    failing: Mapping[str, set[Lane]],
) -> tuple[dict[str, Any], Array]:
    """What the page's script draws, by the scenarios' addresses.

    failing: by scenario, the integrators of which a gate fails.
    """
    made = payload(charts, measured.sweeps, lines, measured.limits, sources, failing)
    description, codes = made
    # Those that have a line, in the page's order, and those with a residual alone.
    others = (residual.engine for own in measured.residuals.values() for residual in own)
    engines = list(dict.fromkeys([*(line.engine for line in lines), *others]))
    for name, drawn in description["scenarios"].items():
        drawn["equation"] = equation_payload(measured.residuals.get(name, []), sources, engines)
        front = measured.fronts.get(name, [])
        drawn["front"] = [[rounded(p.cost), rounded(p.error)] for p in front]
    by_address = {anchors[name]: drawn for name, drawn in description["scenarios"].items()}
    return {**description, "scenarios": by_address}, codes
