"""The page's matrix: how a cell of the summary is worded, and where its numbers come from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import count, product
from typing import Any

from omegadot.reports.summary.figures import Figure, Range
from omegadot.reports.summary.provenance import Sources
from omegadot.reports.summary.summary import STATUSES, Cell, Column, Summary, text_of
from omegadot.reports.text.metric_names import residual_name
from omegadot.reports.text.numbers import knob, quantity, short, times

MARKS = {"pass": "✓", "fail": "✗", "declared": "!", "absent": ""}
# The numbers that the matrix can show, one at a time: the key of `Shown.numbers`, its name.
NUMBERS = {
    "residual": "omega-dot residual (relative)",
    "drift": "angular-momentum drift (relative)",
    "attitude": "attitude error (rad)",
}
FAILED = "failed"


@dataclass(frozen=True)
class Shown:
    """One cell as text.

    mark and status: a sign and its name.  part: how many of its runs fail, or pass, where not all
    do.
    numbers: text by the keys of NUMBERS; where a gate fails, by FAILED its worst measure alone: no
    number that passes stands beside a failure.  card: the number of its card among `cards`.  rank:
    for sorting, the worst first.  gate: the first that fails, if one does.
    far_off: that it passes with an attitude that is of no use, if it does.
    """

    mark: str
    status: str
    part: str
    numbers: dict[str, str]
    card: int = 0
    rank: int = 0
    gate: str = ""
    far_off: str = ""


def origin_of(column: Column, figure: Figure | None = None) -> dict[str, Any]:
    """The source of a number of this column: the run of the figure, or the engine as a whole."""
    engine = {"engine": column.engine, "engine_version": column.version, "setup": column.setup}
    return engine if figure is None else {**vars(figure), **engine}


def shown(cell: Cell, card: int = 0) -> Shown:
    """A cell as the matrix shows it."""
    total, passed = sum(cell.runs.values()), cell.runs.get("pass", 0)
    failed = cell.runs.get("fail", 0)
    part = f"{passed} of {times(total, 'run')} pass" if total and passed != total else ""
    part = f"{failed} of {times(total, 'run')} fail" if cell.status == "fail" and failed else part
    numbers = {
        "residual": "" if cell.residual is None else short(cell.residual.value),
        "drift": _span(cell.drift),
        "attitude": _span(cell.attitude),
    }
    if cell.failed:
        numbers = {FAILED: cell.failed.number}
    rank, gate = STATUSES.index(cell.status), cell.failed.gate if cell.failed else ""
    mark = MARKS.get(cell.status, "–")
    return Shown(mark, text_of(cell.status), part, numbers, card, rank, gate, cell.far_off)


def matrix(summary: Summary) -> list[tuple[str, list[Shown]]]:
    """Rows of the matrix: the scenario's name and its cells in the order of the columns."""
    card = count()  # row by row, as `cards` lists them
    return [
        (name, [shown(summary.cells[name, column], next(card)) for column in summary.columns])
        for name in summary.scenarios
    ]


def lines(summary: Summary, scenario: str, sources: Sources) -> list[dict[str, Any]]:
    """A scenario's row of the matrix, spelt out: one line an engine.

    failed: the failing gate with its number, if one fails.
    numbers: (value, the run behind it) of the worst residual, then best and worst of the drift and
    best and worst of the attitude error.
    """
    found = []
    for column in summary.columns:
        cell = summary.cells[scenario, column]
        ends = [(s.best, s.worst) if s else (None, None) for s in (cell.drift, cell.attitude)]
        figures = [cell.residual, *(figure for pair in ends for figure in pair)]
        numbers = [named(figure) for figure in figures]
        source = sources.number(origin_of(column))
        line = {
            "engine": column.name,
            "shown": shown(cell),
            "failed": cell.failed.text if cell.failed else "",
        }
        found.append({**line, "numbers": numbers, "source": source})
    return found


def _span(span: Range | None) -> str:
    if span is None:
        return ""
    best, worst = short(span.best.value), short(span.worst.value)
    return best if best == worst else f"{best} … {worst}"


def named(figure: Figure | None) -> tuple[str, str]:
    """A figure as text: the value with its unit, and the run behind it."""
    if figure is None:
        return "–", ""
    run = (residual_name(figure.metric), figure.integrator, knob(figure.timestep, figure.accuracy))
    return quantity(figure.value, figure.unit), ", ".join(filter(None, run))


def cards(summary: Summary, sources: Sources, anchors: Mapping[str, str]) -> list[list[Any]]:
    """The card of each cell: ``[address, verdict, part, [[what, value, source], ...]]``.

    In the order of the matrix, row by row.
    """
    found: list[list[Any]] = []
    for name, column in product(summary.scenarios, summary.columns):
        cell = summary.cells[name, column]
        numbers = [
            [what, named(figure)[0], sources.number(origin_of(column, figure))]
            for what, figure in _figures(cell)
        ]
        whole = sources.number(origin_of(column))
        part = (cell.failed.text if cell.failed else "") or shown(cell).part
        found.append([anchors[name], text_of(cell.status), part, numbers, whole])
    return found


def _figures(cell: Cell) -> list[tuple[str, Figure]]:
    found = [("worst omega-dot residual, relative", cell.residual)]
    names = ("angular-momentum drift, relative", "attitude error")
    for what, span in zip(names, (cell.drift, cell.attitude), strict=True):
        if span is not None:
            found += [(f"{what}: best integrator, finest step", span.best)]
            found += [(f"{what}: worst integrator, finest step", span.worst)]
    return [(what, figure) for what, figure in found if figure is not None]
