"""The HTML page: one file, nothing outside it, drawn from a record alone."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import polars as pl

from omegadot.reports import matrix, tables
from omegadot.reports.copies import copies_of, sentence, votes, where
from omegadot.reports.courses import POINTS, Chart, chart_courses
from omegadot.reports.headline import headline, remarks, truth
from omegadot.reports.packing import FLOOR_DECADE, pack_codes, pack_json
from omegadot.reports.payload import command_of, lines_of, payload, step_choices
from omegadot.reports.record import Record
from omegadot.reports.summary import STATUSES, Summary, summarise
from omegadot.reports.sweeps import sweeps_of
from omegadot.reports.templating import asset, environment, plotly
from omegadot.reports.why import order_table, scheme_table

_JUDGED_SHOWN = 50

CHART_TITLES = {
    "omega_dot": ("Omega-dot divergence", "|ω̇ − ω̇ exact| along the run"),
    "energy": ("Energy error", "|E − E exact| along the run"),
    "angular_momentum": ("Angular-momentum error", "|H − H exact|, world axes"),
    "linear_momentum": ("Linear-momentum error", "|p − p exact|, world axes"),
    "attitude": ("Attitude error", "angle between the attitude and the exact one"),
}


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
    courses: tables.Table | None
    votes: str
    engines: tables.Table
    runs: tables.Table


def draw_page(record: Record) -> str:
    """The report of a record, as one self-contained HTML text.

    Charts need JavaScript; the verdicts and every table do not.
    """
    summary = summarise(record)
    charts = {name: chart for name, chart in chart_courses(record).items() if chart.units}
    lines = lines_of(charts.values(), record.run["engines"])
    anchors = _anchors(summary.scenarios)
    sweeps = {anchors[name]: own for name, own in sweeps_of(record.metrics).items()}
    description, codes = payload({anchors[name]: charts[name] for name in charts}, sweeps, lines)
    template = environment().get_template("report.html.j2")
    return template.render(
        run=record.run,
        command=command_of(record.run),
        headline=headline(summary),
        beside=remarks(summary) + truth(summary),
        counts=[(status, summary.runs[status]) for status in STATUSES if summary.runs[status]],
        summary=summary,
        matrix=matrix.matrix(summary),
        numbers=matrix.NUMBERS,
        anchors=anchors,
        judged=_judged(record.metrics),
        schemes=scheme_table(record),
        orders=order_table(record),
        copies=[(sentence(copies), where(copies)) for copies in copies_of(record.run)],
        sections=_sections(record, summary, charts, anchors),
        lines=lines,
        line_groups=_line_groups(lines),
        choices=step_choices(charts.values()),
        chart_titles=CHART_TITLES,
        floor_decade=FLOOR_DECADE,
        points=POINTS,
        css=asset("report.css"),
        js=asset("report.js"),
        plotly=plotly() if charts else "",
        payload=pack_json(description),
        codes=pack_codes(codes),
    )


def _sections(
    record: Record, summary: Summary, charts: Mapping[str, Chart], anchors: Mapping[str, str]
) -> list[Section]:
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
                matrix.lines(summary, name),
                chart,
                tables.course_table(chart) if chart else None,
                votes(record.run, name),
                tables.engine_table(own),
                tables.run_table(own, tasks),
            )
        )
    return sections


def _judged(metrics: pl.DataFrame) -> tuple[list[dict[str, Any]], int]:
    """Failing and declared measures, failures first, each with its worst run and how many runs
    it has; and how many more there are than are shown.
    """
    measure = ["verdict", "scenario", "engine", "engine_version", "gate", "channel", "metric"]
    rows = metrics.filter(pl.col("verdict").is_in(["fail", "declared"])).sort(
        pl.col("verdict") == "declared",
        pl.col("value").fill_nan(float("inf")).fill_null(float("inf")),
        descending=[False, True],
        maintain_order=True,
    )
    rows = rows.group_by(measure, maintain_order=True).agg(
        *(pl.col(name).first() for name in rows.columns if name not in measure),
        runs=pl.len(),
    )
    return rows.head(_JUDGED_SHOWN).to_dicts(), max(0, len(rows) - _JUDGED_SHOWN)


def _anchors(names: tuple[str, ...]) -> dict[str, str]:
    """An address for each scenario: its name where that is plain, made unique by its place."""
    anchors: dict[str, str] = {}
    for place, name in enumerate(names):
        slug = "scenario-" + (re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-") or str(place))
        anchors[name] = slug if slug not in anchors.values() else f"{slug}-{place}"
    return anchors


def _line_groups(lines: list[Any]) -> list[tuple[str, list[tuple[int, Any]]]]:
    """The lines of each engine with their numbers, for the page's own legend."""
    groups: dict[str, list[tuple[int, Any]]] = {}
    for number, line in enumerate(lines):
        groups.setdefault(line.engine, []).append((number, line))
    return list(groups.items())
