"""The HTML page: one file, nothing outside it, drawn from a record alone."""

from __future__ import annotations

import re
from itertools import groupby
from typing import Any

from markupsafe import Markup

from omegadot.reports.charts.chart_library import packed_library
from omegadot.reports.charts.deviations import POINTS, chart_deviations
from omegadot.reports.charts.packing import FLOOR_DECADE, pack_codes, pack_json
from omegadot.reports.charts.palette import Line, lines_of
from omegadot.reports.charts.payload import step_choices
from omegadot.reports.choice.page import Section
from omegadot.reports.page.failures_table import Failure, failures_table
from omegadot.reports.page.glance import glances
from omegadot.reports.page.glossary import INTRODUCTION, TERMS
from omegadot.reports.page.sections import drawings, failing_lanes, measured_in, sections_of
from omegadot.reports.page.templating import asset, environment, script
from omegadot.reports.page.view_3d.view import view_section
from omegadot.reports.page.why import order_table, scheme_table
from omegadot.reports.record.record import Record
from omegadot.reports.shipped import table as shipped_table
from omegadot.reports.shipped.rows import shipped_rows
from omegadot.reports.summary import matrix
from omegadot.reports.summary.cluster_sentences import extent, sentence
from omegadot.reports.summary.clusters import clusters_over_scenarios
from omegadot.reports.summary.headline import headline, remarks, step_notes, truth
from omegadot.reports.summary.provenance import command_of, provenance_payload, sources_for
from omegadot.reports.summary.summary import STATUSES, counts, summarise

MOST_FAILING = 3  # engines in full at the top of the page; the others are folded
CHART_TITLES = {
    "omega_dot": ("Omega-dot error", "|ω̇ − ω̇ exact| along the run"),
    "energy": ("Energy error", "|E − E exact| along the run"),
    "angular_momentum": ("Angular-momentum error", "|H − H exact|, world axes"),
    "linear_momentum": ("Linear-momentum error", "|p − p exact|, world axes"),
    "attitude": ("Attitude error", "angle between the attitude and the exact one"),
}


def draw_page(record: Record, choice: Section | None = None) -> str:
    """The report of a record, as one self-contained HTML text.

    choice: a choice of engine stored with the run, a section of its own.
    Charts need JavaScript; the verdicts and every table do not.
    """
    library = packed_library()
    summary = summarise(record)
    sources = sources_for(record.run["engines"])
    charts = {name: chart for name, chart in chart_deviations(record).items() if chart.units}
    lines = lines_of(charts.values(), record.run["engines"])
    anchors = _anchors(summary.scenarios)
    measured = measured_in(record.metrics)
    failing = failing_lanes(record.metrics)
    description, codes = drawings(measured, charts, lines, anchors, sources, failing)
    drawn = description["scenarios"]
    sections = [*sections_of(record, summary, charts, anchors, sources, measured, drawn)]
    failures = failures_table(record, summary.columns, sources)
    schemes, orders = scheme_table(record, sources), order_table(record, sources)
    engines = glances(summary, record.metrics, sources)
    cards = matrix.cards(summary, sources, anchors)
    styles = ["report.css", "scenarios.css", "view.css"] + (["plot.css"] if choice else [])
    # Last, when every table and chart has named its sources.
    origins = provenance_payload(record.run, sources, anchors) | {"cards": cards}
    template = environment().get_template("report.html.j2")
    return template.render(
        run=record.run,
        command=command_of(record.run),
        choice=choice,
        shipped=_shipped(record),
        headline=record.run.get("headline") or headline(summary),
        remarks=remarks(summary) + truth(summary),
        counts=counts(summary),
        summary=summary,
        most_failing=MOST_FAILING,
        matrix=matrix.matrix(summary),
        numbers=matrix.NUMBERS,
        anchors=anchors,
        glances=engines,
        step_notes=step_notes(record.run["engines"]),
        failures=failures,
        schemes=schemes,
        orders=orders,
        clusters=[(sentence(c), extent(c)) for c in clusters_over_scenarios(record.run)],
        sections=sections,
        opened=_opened(sections, failures[0], anchors),
        lines=lines,
        line_groups=[(engine, list(own)) for engine, own in groupby(enumerate(lines), _engine_of)],
        choices=step_choices(charts.values()),
        chart_titles=CHART_TITLES,
        floor_decade=FLOOR_DECADE,
        points=POINTS,
        glossary=TERMS,
        glossary_introduction=INTRODUCTION,
        css=Markup("").join(asset(name) for name in styles) + line_styles(lines),
        view=view_section(record, charts, lines, anchors),
        js=script(),
        plotly=library.result() if charts else "",
        payload=pack_json(description),
        codes=pack_codes(codes),
        provenance=pack_json(origins),
    )


def _shipped(record: Record) -> dict[str, Any]:
    """The table of a run in both setups; {} of another."""
    rows = shipped_rows(record)
    if not rows:
        return {}
    found, most = shipped_table.cells(rows), shipped_table.MOST
    texts = {"rows": found[:most], "more": found[most:], "note": shipped_table.note(rows)}
    return {"heads": shipped_table.heads(rows), **texts}


def _anchors(names: tuple[str, ...]) -> dict[str, str]:
    """An address for each scenario: its name where that is plain, made unique by its place."""
    anchors: dict[str, str] = {}
    for place, name in enumerate(names):
        slug = "scenario-" + (re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-") or str(place))
        anchors[name] = slug if slug not in anchors.values() else f"{slug}-{place}"
    return anchors


def _opened(
    sections: list[dict[str, Any]], failures: list[Failure], anchors: dict[str, str]
) -> str:
    """The address of the scenario that is shown first: that of the first failure, if there is one,
    else one with the worst verdict.
    """
    failed = (anchors[row.scenario] for row in failures if row.scenario in anchors)
    worst = min(sections, key=lambda s: STATUSES.index(s["status"]), default={"anchor": ""})
    return next(failed, str(worst["anchor"]))


def line_styles(lines: list[Line]) -> Markup:
    """A class a line, `n` and its number: on paper colours are those of the light."""
    pairs = list(dict.fromkeys(line.colour for line in lines))
    light, dark = ("".join(f"--c{k}:{p[n]};" for k, p in enumerate(pairs)) for n in (0, 1))
    looks = [
        f".n{k}{{stroke:var(--c{pairs.index(line.colour)});stroke-width:{line.width}px"
        + (f";stroke-dasharray:{line.dash}}}" if line.dash else "}")
        for k, line in enumerate(lines)
    ]
    screen = f"@media screen and (prefers-color-scheme:dark){{:root{{{dark}}}}}"
    return Markup("\n".join([f":root{{{light}}}", screen, *looks]))


def _engine_of(numbered: tuple[int, Line]) -> str:
    return numbered[1].engine
