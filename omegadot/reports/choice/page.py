"""The page of a choice, in the report's look and without script, and the folder that holds it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from omegadot.reports.choice import sentences, tables
from omegadot.reports.choice.chart import drawing
from omegadot.reports.page.templating import asset, environment
from omegadot.reports.record.run_json import dump_json
from omegadot.reports.record.schema import RecordError
from omegadot.reports.record.whole_file import write_whole
from omegadot.reports.summary.provenance import command_of

NAME = "choice.json"

# A choice as the template takes it, on a page of its own or in a run's.
Section = dict[str, Any]


def section_of(choice: Mapping[str, Any]) -> Section:
    """The section of a choice, as ``choice.json`` holds it: a part for each scenario."""
    return {
        "requested": sentences.requested(choice),
        "command": command_of(choice),
        "guarantee": sentences.GUARANTEE,
        "overall": tables.everywhere(choice),
        "parts": [
            {
                "name": case["name"],
                "title": case["title"],
                "headline": sentences.headline(case),
                "qualify": tables.ranking(choice, case),
                "out": tables.refusals(case),
                "changes": list(sentences.variant_lines(case)),
                "chart": drawing(case, choice["engines"]),
            }
            for case in choice["scenarios"]
        ],
        "notes": list(sentences.notes(choice)),
    }


def draw_choice(choice: Mapping[str, Any]) -> str:
    """The whole page."""
    section = section_of(choice)
    (first, *_) = section["parts"]
    several = section["overall"] is not None
    return (
        environment()
        .get_template("choice_page.html.j2")
        .render(
            choice=choice,
            headline=sentences.verdict_everywhere(choice) if several else first["headline"],
            chosen=section,
            css=asset("report.css") + asset("plot.css"),
        )
    )


def read_choice(folder: Path) -> Section | None:
    """The section of a choice that is stored with a run; None where there is none.

    Raises RecordError, one sentence, where it is not one that omegadot wrote.
    """
    path = folder / NAME
    if not path.is_file():
        return None
    try:
        return section_of(json.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError, RecursionError, LookupError, TypeError, AttributeError) as error:
        raise RecordError(
            f"{path}: not a choice that omegadot wrote; remove it or choose again."
        ) from error


def write_choice(choice: Mapping[str, Any], folder: Path) -> None:
    """Page and JSON, each whole or not at all. Raises RecordError."""
    write_whole(folder / NAME, dump_json(choice))
    write_whole(folder / "choice.html", draw_choice(choice))
