"""A comparison as text: for the terminal, for a pull request, and for machines."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import asdict
from typing import Any

from omegadot.reports.text.markdown_text import COMMENT, code, escape, folded, table
from omegadot.reports.text.numbers import times
from omegadot.reports.two_runs.change import Change
from omegadot.reports.two_runs.comparison import Comparison
from omegadot.reports.two_runs.listing import Part, parts_of, remarks, side_facts
from omegadot.reports.two_runs.sides import Side, Task

_ROWS_SHOWN = 12
# Reported for information, after what is judged.
_FOLDED = ("settings", "cost")
_PRESENT = ("vanished", "appeared")


def as_text(comparison: Comparison) -> str:
    """What changed, the largest change first, and the verdict in the last line."""
    lines = [f"{side.label}: {side_facts(side)}" for side in (comparison.was, comparison.now)]
    for part in parts_of(comparison):
        lines += ["", _title(part), *_paragraphs(part)]
    lines += ["", comparison.headline, *remarks(comparison)]
    return "\n".join(map(_printable, lines))


def _printable(line: str) -> str:
    """Without what would move a terminal's cursor or colour it."""
    return "".join(c if c.isprintable() else " " for c in line)


def _title(part: Part) -> str:
    return part.title + ("; reported, not judged." if part.anchor == "cost" else "")


def _paragraphs(part: Part) -> list[str]:
    shown = ["  " + "  ".join(filter(None, _cells(part, row))) for row in part.rows[:_ROWS_SHOWN]]
    left = len(part.rows) - _ROWS_SHOWN
    return [*shown, f"  and {left} more; --format json has them all"] if left > 0 else shown


def _cells(part: Part, row: tuple[str, ...]) -> tuple[str, ...]:
    """A row as it reads without heads above it."""
    if part.anchor == "settings":
        what, was, now = row
        return f"{what}:", f"{was} → {now}"
    if part.anchor == "cost":
        *names, median, span, runs = row
        return *names, f"{median} times ({span}), {times(int(runs), 'run')}"
    if part.anchor in _PRESENT:
        *names, runs, scenarios, why = row
        return *names, times(int(runs), "run"), scenarios, why
    return row


def as_markdown(comparison: Comparison) -> str:
    """A comment for a pull request, below the length that one may have."""
    mark = "❌ " if comparison.regressed else ""
    lines = [f"### {mark}{escape(comparison.headline, 1000)}", ""]
    lines += [f"{escape(message, 1000)}\n" for message in remarks(comparison)]
    for name, side in (("First", comparison.was), ("Second", comparison.now)):
        lines.append(f"- {name}: {code(side.label, 300)}, {escape(side_facts(side), 600)}")
    for part in parts_of(comparison):
        if part.anchor in _FOLDED:
            lines += folded(_title(part), table(part.heads, part.rows, COMMENT // 8))
        else:
            lines += ["", f"**{part.title}**", "", *table(part.heads, part.rows, COMMENT // 6)]
    return "\n".join(lines) + "\n"


def as_json(comparison: Comparison) -> dict[str, Any]:
    """Everything, for machines; what is not finite is null."""
    return {
        "regressed": comparison.regressed,
        "headline": comparison.headline,
        "compared": {"runs": comparison.runs, "figures": comparison.figures},
        "first": _side(comparison.was),
        "second": _side(comparison.now),
        "worse": _changes(comparison.worse),
        "better": _changes(comparison.better),
        "vanished": _tasks(comparison.vanished),
        "appeared": _tasks(comparison.appeared),
        "redefined_scenarios": sorted(comparison.redefined),
        "settings": [asdict(difference) for difference in comparison.settings],
        "costs": [asdict(cost) for cost in comparison.costs],
    }


def _side(side: Side) -> dict[str, Any]:
    names = ("created", "omegadot", "machine", "versions", "seed", "command")
    return {"label": side.label, **{name: side.run.get(name) for name in names}}


def _changes(changes: Iterable[Change]) -> list[dict[str, Any]]:
    found = []
    for change in changes:
        names = ("gate", "channel", "metric", "was", "now", "moved", "why")
        entry = change.key._asdict() | {name: getattr(change, name) for name in names}
        if change.measure is not None:
            entry |= {
                "value_was": change.measure.was,
                "value_now": change.measure.now,
                "band": change.measure.band if math.isfinite(change.measure.band) else None,
                "unit": change.measure.unit,
            }
        found.append(entry)
    return found


def _tasks(tasks: Iterable[Task]) -> list[dict[str, Any]]:
    return [
        {**task.key._asdict(), "outcome": task.outcome, "status": task.status, "why": task.why}
        for task in tasks
    ]
