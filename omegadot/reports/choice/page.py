"""The page of a choice, in the report's look and without script, and the folder that holds it."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from omegadot.reports.charts.palette import colours, dashes
from omegadot.reports.charts.plot import Frame, LogAxis, Plot, PlotLine
from omegadot.reports.choice import sentences, tables
from omegadot.reports.page.templating import asset, environment
from omegadot.reports.record.run_json import dump_json
from omegadot.reports.record.schema import RecordError
from omegadot.reports.record.whole_file import PAGE_MARK, write_whole
from omegadot.reports.summary.provenance import command_of
from omegadot.reports.text.numbers import knob
from omegadot.written import written

NAME = "choice.json"
_FRAME = Frame(width=720, height=340, left=62, right=12, top=12, bottom=44)

_NOT_OURS = (
    *(OSError, ValueError, RecursionError, LookupError, TypeError, AttributeError),
    ArithmeticError,
)

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
                "chart": _drawing(case, choice["engines"]),
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
        return section_of(json.loads(path.read_text(encoding="utf-8-sig")))
    except _NOT_OURS as error:
        raise RecordError(
            f"{path}: not a choice that omegadot wrote; remove it or choose again."
        ) from error


def write_choice(choice: Mapping[str, Any], folder: Path) -> None:
    """Page and JSON, each whole or not at all. Raises RecordError."""
    write_whole(folder / NAME, dump_json(choice), '"kind": "choice"')
    write_whole(folder / "choice.html", draw_choice(choice), PAGE_MARK)


@dataclass(frozen=True)
class Drawing(Plot):
    """limit: the height of an error equal to its limit."""

    limit: float


def _axis(values: list[float], start: float, end: float) -> LogAxis:
    low, high = math.log10(min(values)), math.log10(max(values))
    return LogAxis(math.floor(low - 0.05), math.ceil(high + 0.05), start, end)


def _ticks(axis: LogAxis) -> list[tuple[float, str]]:
    return axis.ticks(math.ceil((axis.high - axis.low) / 8))


def _runs(row: Mapping[str, Any], duration: float) -> list[tuple[float, float, str]]:
    """(seconds a simulated second, error over limit, step or accuracy) of the runs to draw."""
    per_step = row["time_per_step"]
    seconds = per_step["median"] if per_step else None
    found = []
    for trial in row["tried"]:
        ratio, one = trial["ratio"], seconds or trial["seconds_per_step"]
        if ratio and one and math.isfinite(ratio):
            parts = (trial["timestep"], trial["accuracy"])
            setting = knob(*(part and float(f"{part:.4g}") for part in parts))
            found.append((one * trial["steps"] / duration, ratio, setting))
    return sorted(found)


def _drawing(case: Mapping[str, Any], engines: list[dict[str, Any]]) -> Drawing | None:
    """The drawing of a case; None where nothing can be drawn."""
    runs = {
        (row["engine"], row["integrator"]): found
        for row in case["candidates"]
        if (found := _runs(row, case["duration"]))
    }
    if not runs:
        return None
    every = [run for found in runs.values() for run in found]
    x = _axis([cost for cost, _, _ in every], _FRAME.left, _FRAME.width - _FRAME.right)
    floor = _FRAME.height - _FRAME.bottom
    y = _axis([ratio for _, ratio, _ in every] + [1.0], floor, _FRAME.top)
    ink, dash = colours(e["name"] for e in engines), dashes(engines)
    lines = []
    for (engine, integrator), found in runs.items():
        name = f"{engine} {integrator}"
        marks = [
            (x.at(cost), y.at(ratio), f"{name}, {setting}: {written(ratio, 3)}")
            for cost, ratio, setting in found
        ]
        path = "M" + " L".join(f"{a} {b}" for a, b, _ in marks)
        lines.append(PlotLine(name, ink[engine], dash.get((engine, integrator), ""), path, marks))
    title = f"{case['name']}: error over limit against cost, every run tried"
    return Drawing(title, _FRAME, lines, _ticks(x), _ticks(y), y.at(1.0))
