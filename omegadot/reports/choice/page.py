"""The page of a choice: one file, nothing outside it, in the report's look, without script."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from omegadot.reports.choice import sentences as texts
from omegadot.reports.choice import tables as tables
from omegadot.reports.choice.chart import HEIGHT, WIDTH, Drawing, drawing
from omegadot.reports.page.templating import asset, environment
from omegadot.reports.summary.provenance import command_of


@dataclass(frozen=True)
class Part:
    """One scenario of a section."""

    name: str
    title: str
    headline: str
    qualify: tables.Grid
    out: tables.Grid
    changes: list[str]
    chart: Drawing | None


def parts(choice: Mapping[str, Any]) -> list[Part]:
    """What the section shows of each scenario."""
    return [
        Part(
            case["name"],
            case["title"],
            texts.headline(case),
            tables.ranking(choice, case),
            tables.refusals(case),
            list(texts.variant_lines(case)),
            drawing(case, choice["engines"]),
        )
        for case in choice["scenarios"]
    ]


@dataclass(frozen=True)
class Section:
    """A choice on a page, its own or a run's. requested: the requirements as text."""

    requested: str
    command: str
    guarantee: str
    overall: tables.Grid | None
    parts: list[Part]
    notes: list[str]
    width: float = WIDTH
    height: float = HEIGHT


def section_of(choice: Mapping[str, Any]) -> Section:
    """The section of a choice, as ``choice.json`` holds it."""
    return Section(
        texts.requested(choice),
        command_of(choice),
        texts.GUARANTEE,
        tables.everywhere(choice),
        parts(choice),
        list(texts.notes(choice)),
    )


def draw_choice(choice: Mapping[str, Any]) -> str:
    """The whole page."""
    section = section_of(choice)
    lines = [texts.headline(case) for case in choice["scenarios"]]
    template = environment().get_template("choice_page.html.j2")
    return template.render(
        choice=choice,
        headline=texts.verdict_everywhere(choice) if section.overall else lines[0],
        chosen=section,
        css=asset("report.css"),
        own_css=asset("choice.css"),
    )
