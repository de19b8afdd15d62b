"""Two records side by side on one self-contained page, in the look of a run's own report."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from packaging.version import InvalidVersion, Version

from omegadot.reports.page.templating import asset, environment
from omegadot.reports.summary import matrix
from omegadot.reports.summary.provenance import command_of
from omegadot.reports.summary.summary import Cell, Column, Summary, summarise
from omegadot.reports.text.numbers import engine_name, times
from omegadot.reports.two_runs.change import Change
from omegadot.reports.two_runs.comparison import Comparison
from omegadot.reports.two_runs.listing import engines_of, parts_of, remarks
from omegadot.reports.two_runs.sides import Side, several_versions

_ROWS_SHOWN = 200
_ABSENT = matrix.Shown("", "not run", "", {})

# An engine with its setup; its version, too, where a record has several of it.
Key = tuple[str, str, str]


@dataclass(frozen=True)
class Pair:
    """One engine in both records. label: over its column, with both versions."""

    key: Key
    label: str
    versions: str
    columns: tuple[Column | None, Column | None]


def draw_two_runs(comparison: Comparison) -> str:
    """Both records as one HTML text that fetches nothing and needs no script."""
    sides = comparison.was, comparison.now
    summaries = [summarise(side.record) for side in sides]
    columns = _columns(summaries, several_versions(sides))
    template = environment().get_template("two_runs.html.j2")
    return template.render(
        comparison=comparison,
        remarks=remarks(comparison),
        sides=[_facts(side) for side in sides],
        columns=columns,
        matrix=_matrix(comparison, summaries, columns),
        numbers=matrix.NUMBERS,
        parts=parts_of(comparison),
        most=_ROWS_SHOWN,
        css=asset("report.css") + asset("two_runs.css"),
    )


def _facts(side: Side) -> dict[str, str]:
    """The facts about a record at the top of the page."""
    run = side.run
    machine = run.get("machine") or {}
    return {
        "folder": side.label,
        "made": str(run.get("created") or ""),
        "omegadot": str(run.get("omegadot") or ""),
        "engines": ", ".join(engines_of(run).values()),
        "machine": ", ".join(f"{key} {value}" for key, value in machine.items()),
        "seed": str(run.get("seed", "")),
        "runs": times(len(run["tasks"]), "run") + ("" if side.complete else ", interrupted"),
        "command": command_of(run),
    }


def _rising(column: Column) -> tuple[Version, str]:
    """By version as releases are ordered, 3.10 after 3.9; what is no version comes first."""
    try:
        return Version(column.version), column.version
    except InvalidVersion:
        return Version("0.dev0"), column.version


def _columns(summaries: Iterable[Summary], versioned: set[str]) -> list[Pair]:
    """The engines of both records, each paired with itself; several versions of one kept apart."""

    def key(column: Column) -> Key:
        version = column.version if column.engine in versioned else ""
        return column.engine, column.setup, version

    both = [summary.columns for summary in summaries]
    # An engine that did not start has no version, and is no column of its own.
    then, today = ({key(c): c for c in sorted(own, key=_rising)} for own in both)
    found = []
    for place in dict.fromkeys(key(column) for own in both for column in own):
        pair = then.get(place), today.get(place)
        engine, setup, version = place
        versions = dict.fromkeys(column.version or "–" for column in pair if column is not None)
        shown = "" if version else " → ".join(versions)
        found.append(Pair(place, engine_name(engine, version, setup), shown, pair))
    return found


def _matrix(
    comparison: Comparison, summaries: list[Summary], columns: list[Pair]
) -> list[tuple[str, list[dict[str, Any]]]]:
    changes: dict[tuple[str, Key], list[Change]] = {}
    for change in (*comparison.worse, *comparison.better):
        run = change.key
        changes.setdefault((run.scenario, (run.engine, run.setup, run.version)), []).append(change)

    def cell(name: str, pair: Pair) -> dict[str, Any]:
        was, now = (
            summary.cells.get((name, column)) if column is not None else None
            for summary, column in zip(summaries, pair.columns, strict=True)
        )
        return _cell(was, now, changes.get((name, pair.key), []))

    names = dict.fromkeys(name for summary in summaries for name in summary.scenarios)
    return [(name, [cell(name, pair) for pair in columns]) for name in names]


def _cell(was: Cell | None, now: Cell | None, changes: Iterable[Change]) -> dict[str, Any]:
    """A cell of the matrix: what either record shows, and what changed.

    mood: "worse", "better", "mixed", "same", "appeared" or "vanished".  change: as text.
    """
    one, other = (
        _ABSENT if cell is None or not cell.runs else matrix.shown(cell) for cell in (was, now)
    )
    if one is _ABSENT or other is _ABSENT:
        mood = "" if one is other else "appeared" if one is _ABSENT else "vanished"
        return {"was": one, "now": other, "mood": mood, "change": mood}
    worse = sum(change.worse for change in changes)
    better = sum(not change.worse for change in changes)
    message = [f"{count} {term}" for count, term in ((worse, "worse"), (better, "better")) if count]
    mood = "mixed" if worse and better else "worse" if worse else "better" if better else "same"
    change = ", ".join(message) or "no change"
    return {"was": one, "now": other, "mood": mood, "change": change}
