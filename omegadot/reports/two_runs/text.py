"""A comparison as text: for the terminal, for a pull request, and for machines."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import asdict
from typing import Any

from omegadot.reports.text.markdown_text import COMMENT, code, escape, folded, table
from omegadot.reports.text.numbers import times
from omegadot.reports.two_runs import listing as listing
from omegadot.reports.two_runs.change import Change
from omegadot.reports.two_runs.comparison import Comparison
from omegadot.reports.two_runs.sides import Side, Task

_ROWS_SHOWN = 12


def as_text(comparison: Comparison) -> str:
    """What changed, the largest change first, and the verdict in the last line."""
    lines = [f"{side.label}: {listing.side_facts(side)}" for side in _sides(comparison)]
    for title, rows in _sections(comparison):
        if rows:
            lines += ["", title, *_paragraphs(rows)]
    lines += ["", comparison.headline, *listing.remarks(comparison)]
    return "\n".join(" ".join(_printable(line).split(" ")) for line in lines)


def _printable(line: str) -> str:
    """Without what would move a terminal's cursor or colour it."""
    return "".join(c if c.isprintable() else " " for c in line)


def _sides(comparison: Comparison) -> tuple[Side, Side]:
    return comparison.was, comparison.now


def _sections(comparison: Comparison) -> list[tuple[str, listing.Rows]]:
    return [
        ("Worse", listing.change_rows(comparison.worse)),
        ("Better", listing.change_rows(comparison.better)),
        ("Vanished", listing.presence_rows(comparison.vanished)),
        ("Appeared", listing.presence_rows(comparison.appeared)),
        ("Different settings", [(f"{a}:", f"{b} → {c}") for a, b, c in _settings(comparison)]),
        (listing.COST_NOTE, _costs(comparison)),
    ]


def _settings(comparison: Comparison) -> listing.Rows:
    return listing.setting_rows(comparison)


def _costs(comparison: Comparison) -> listing.Rows:
    rows = listing.cost_rows(comparison)
    return [
        (e, i, f"{median} times ({span}), {times(int(n), 'run')}") for e, i, median, span, n in rows
    ]


def _paragraphs(rows: listing.Rows) -> list[str]:
    shown = ["  " + "  ".join(filter(None, row)) for row in rows[:_ROWS_SHOWN]]
    left = len(rows) - _ROWS_SHOWN
    return [*shown, f"  and {left} more; --format json has them all"] if left > 0 else shown


def as_markdown(comparison: Comparison) -> str:
    """A comment for a pull request, below the length that one may have."""
    mark = "❌ " if comparison.regressed else ""
    lines = [f"### {mark}{escape(comparison.headline, 1000)}", ""]
    lines += [f"{escape(message, 1000)}\n" for message in listing.remarks(comparison)]
    for name, side in zip(("First", "Second"), _sides(comparison), strict=True):
        lines.append(f"- {name}: {code(side.label, 300)}, {escape(listing.side_facts(side), 600)}")
    parts = (
        ("Worse", listing.CHANGE_HEADS, listing.change_rows(comparison.worse)),
        ("Better", listing.CHANGE_HEADS, listing.change_rows(comparison.better)),
        ("Vanished", listing.PRESENCE_HEADS, listing.presence_rows(comparison.vanished)),
        ("Appeared", listing.PRESENCE_HEADS, listing.presence_rows(comparison.appeared)),
    )
    for title, heads, rows in parts:
        if rows:
            lines += ["", f"**{title}**", "", *table(heads, rows, COMMENT // 6)]
    if rows := listing.setting_rows(comparison):
        lines += folded("Different settings", table(listing.SETTING_HEADS, rows, COMMENT // 8))
    if rows := listing.cost_rows(comparison):
        reported = table(listing.COST_HEADS, rows, COMMENT // 8)
        lines += folded(listing.COST_NOTE, reported)
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
