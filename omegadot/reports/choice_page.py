"""The page of a choice: one file, nothing outside it, in the report's look, without script."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from omegadot.reports import choice as words
from omegadot.reports import choice_tables as tables
from omegadot.reports.choice_chart import HEIGHT, WIDTH, Drawing, drawing
from omegadot.reports.templating import asset, environment


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
            words.headline(case),
            tables.ranking(choice, case),
            tables.refusals(case),
            list(words.variant_lines(case)),
            drawing(case, choice["engines"]),
        )
        for case in choice["scenarios"]
    ]


@dataclass(frozen=True)
class Section:
    """What a page says of a choice, its own page or a run's. asked: the requirements in words."""

    asked: str
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
        words.asked(choice),
        shlex.join(choice.get("command", ())),
        words.GUARANTEE,
        tables.everywhere(choice),
        parts(choice),
        list(words.notes(choice)),
    )


def draw_choice(choice: Mapping[str, Any]) -> str:
    """The whole page."""
    section = section_of(choice)
    lines = [words.headline(case) for case in choice["scenarios"]]
    template = environment().get_template("choice_page.html.j2")
    return template.render(
        choice=choice,
        headline=words.verdict_everywhere(choice) if section.overall else lines[0],
        chosen=section,
        css=asset("report.css"),
        own_css=asset("choice.css"),
    )
