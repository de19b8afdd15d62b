"""The page's matrix: how a cell of the summary is worded, and where its numbers come from."""

from __future__ import annotations

from dataclasses import dataclass

from omegadot.reports.numbers import knob, short
from omegadot.reports.summary import Cell, Column, Figure, Range, Summary

MARKS = {"pass": "✓", "fail": "✗", "declared": "!", "absent": ""}
# The numbers that the matrix can show, one at a time: the key of `Shown.numbers`, its name.
NUMBERS = {
    "residual": "omega-dot residual (relative)",
    "drift": "angular-momentum drift (relative)",
    "attitude": "attitude error (rad)",
}


@dataclass(frozen=True)
class Shown:
    """One cell in words. mark and status: a sign and a word.  part: how many of its runs passed,
    where not all did.  numbers: text by the keys of NUMBERS.
    """

    mark: str
    status: str
    part: str
    numbers: dict[str, str]


@dataclass(frozen=True)
class Line:
    """One engine on one scenario, with the run behind each number."""

    engine: str
    shown: Shown
    residual: str
    drift: str
    attitude: str


def shown(cell: Cell) -> Shown:
    """A cell as the matrix shows it."""
    total, passed = sum(cell.runs.values()), cell.runs.get("pass", 0)
    part = f"{passed} of {total} runs pass" if total and passed != total else ""
    numbers = {
        "residual": "" if cell.residual is None else short(cell.residual.value),
        "drift": _span(cell.drift),
        "attitude": _span(cell.attitude),
    }
    return Shown(MARKS.get(cell.status, "–"), _word(cell.status), part, numbers)


def matrix(summary: Summary) -> list[tuple[str, list[Shown]]]:
    """Rows of the matrix: the scenario's name and its cells in the order of the columns."""
    return [
        (name, [shown(summary.cells[name, column]) for column in summary.columns])
        for name in summary.scenarios
    ]


def lines(summary: Summary, scenario: str) -> list[Line]:
    """A scenario's row of the matrix, spelt out: one line an engine."""
    return [_line(column, summary.cells[scenario, column]) for column in summary.columns]


def _line(column: Column, cell: Cell) -> Line:
    return Line(
        " ".join(filter(None, (column.label, "" if column.version in column.label else column.version))),
        shown(cell),
        "–" if cell.residual is None else _named(cell.residual),
        _spelt(cell.drift),
        _spelt(cell.attitude),
    )


def _span(span: Range | None) -> str:
    if span is None:
        return ""
    best, worst = short(span.best.value), short(span.worst.value)
    return best if best == worst else f"{best} … {worst}"


def _spelt(span: Range | None) -> str:
    if span is None:
        return "–"
    if span.best is span.worst:
        return _named(span.worst)
    return f"{_named(span.best)} to {_named(span.worst)}"


def _named(figure: Figure) -> str:
    unit = "" if figure.unit == "1" else f" {figure.unit}"
    run = filter(None, (figure.integrator, knob(figure.timestep, figure.accuracy)))
    source = ", ".join([*run] if figure.metric != "residual_on_path" else ["along the path", *run])
    return f"{short(figure.value)}{unit}" + (f" ({source})" if source else "")


def _word(status: str) -> str:
    return {"not-judged": "not judged", "not-installed": "not installed", "absent": "not run"}.get(
        status, status
    )
