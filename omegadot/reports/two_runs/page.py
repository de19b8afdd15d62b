"""Two records side by side on one self-contained page, in the look of a run's own report."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from omegadot.reports.page.templating import asset, environment
from omegadot.reports.summary import matrix
from omegadot.reports.summary.summary import Cell, Column, Summary, summarise
from omegadot.reports.text.numbers import times
from omegadot.reports.two_runs import listing as listing
from omegadot.reports.two_runs.change import Change
from omegadot.reports.two_runs.comparison import Comparison
from omegadot.reports.two_runs.sides import RunKey, Side, several_versions

_ROWS_SHOWN = 200


@dataclass(frozen=True)
class Pair:
    """One engine in both records. label: over its column, with both versions."""

    label: str
    versions: str
    was: Column | None
    now: Column | None


@dataclass(frozen=True)
class PairCell:
    """A cell of the matrix: what either record shows, and what changed.

    status: the second record's, or the first one's where the second has nothing.
    mood: "worse", "better", "mixed", "same", "appeared" or "vanished".  change: as text.
    """

    was: matrix.Shown
    now: matrix.Shown
    status: str
    mood: str
    change: str


@dataclass(frozen=True)
class Part:
    """A table of the page. rows: those shown.  hidden: how many more there are."""

    anchor: str
    title: str
    heads: tuple[str, ...]
    rows: listing.Rows
    hidden: int


def draw_two_runs(comparison: Comparison) -> str:
    """Both records as one HTML text that fetches nothing and needs no script."""
    summaries = summarise(comparison.was.record), summarise(comparison.now.record)
    columns = _columns(*summaries, several_versions((comparison.was, comparison.now)))
    return (
        environment()
        .get_template("two_runs.html.j2")
        .render(
            comparison=comparison,
            remarks=listing.remarks(comparison),
            sides=[_facts(side) for side in (comparison.was, comparison.now)],
            columns=columns,
            matrix=_matrix(comparison, summaries, columns),
            numbers=matrix.NUMBERS,
            parts=_parts(comparison),
            css=asset("report.css") + asset("two_runs.css"),
        )
    )


def _facts(side: Side) -> dict[str, str]:
    """The facts about a record at the top of the page."""
    run = side.run
    machine = run.get("machine") or {}
    engines = (
        f"{entry['name']} {entry.get('version') or ''}".strip()
        for entry in run["engines"]
        if entry.get("installed") is not False
    )
    return {
        "folder": side.label,
        "made": str(run.get("created") or ""),
        "omegadot": str(run.get("omegadot") or ""),
        "engines": ", ".join(engines),
        "machine": ", ".join(f"{key} {value}" for key, value in machine.items()),
        "seed": str(run.get("seed", "")),
        "runs": times(len(run["tasks"]), "run") + ("" if side.complete else ", interrupted"),
        "command": side.command,
    }


def _columns(was: Summary, now: Summary, versioned: set[str]) -> list[Pair]:
    """The engines of both records, each paired with itself; several versions of one kept apart."""

    def key(column: Column) -> tuple[str, str, str]:
        version = column.version if column.engine in versioned else ""
        return column.engine, column.setup, version

    # An engine that did not start has no version, and is no column of its own.
    then, today = ({key(c): c for c in sorted(s.columns, key=_named)} for s in (was, now))
    found = []
    for place in dict.fromkeys((*map(key, was.columns), *map(key, now.columns))):
        one, other = then.get(place), today.get(place)
        versions = [column.version or "–" for column in (one, other) if column is not None]
        engine, setup, version = place
        label = " ".join(filter(None, (engine, version, "" if setup == "physics" else setup)))
        shown = " → ".join(dict.fromkeys(versions)) if not version else ""
        found.append(Pair(label, shown, one, other))
    return found


def _named(column: Column) -> bool:
    return bool(column.version)


def _matrix(
    comparison: Comparison, summaries: tuple[Summary, Summary], columns: list[Pair]
) -> list[tuple[str, list[PairCell]]]:
    names = dict.fromkeys((*summaries[0].scenarios, *summaries[1].scenarios))
    changes: dict[tuple[str, str, str], list[Change]] = {}
    for change in (*comparison.worse, *comparison.better):
        changes.setdefault(_place(change.key), []).append(change)

    def cell(name: str, pair: Pair) -> PairCell:
        both = [
            summary.cells.get((name, column)) if column is not None else None
            for summary, column in zip(summaries, (pair.was, pair.now), strict=True)
        ]
        column = pair.now or pair.was
        assert column is not None  # a pair is of one at least
        version = column.version if pair.label.split(" ")[1:2] == [column.version] else ""
        own = changes.get((name, f"{column.engine} {version}".strip(), column.setup), [])
        return _cell(both[0], both[1], own)

    return [(name, [cell(name, pair) for pair in columns]) for name in names]


def _place(key: RunKey) -> tuple[str, str, str]:
    return key.scenario, f"{key.engine} {key.version}".strip(), key.setup


_ABSENT = matrix.Shown("", "not run", "", {})


def _cell(was: Cell | None, now: Cell | None, changes: Iterable[Change]) -> PairCell:
    one, other = (
        _ABSENT if cell is None or not cell.runs else matrix.shown(cell) for cell in (was, now)
    )
    worse = sum(change.worse for change in changes)
    better = sum(not change.worse for change in changes)
    if one is _ABSENT or other is _ABSENT:
        mood = "" if one is other else "appeared" if one is _ABSENT else "vanished"
        return PairCell(one, other, (one if other is _ABSENT else other).status, mood, mood)
    message = [f"{count} {term}" for count, term in ((worse, "worse"), (better, "better")) if count]
    mood = "mixed" if worse and better else "worse" if worse else "better" if better else "same"
    return PairCell(one, other, other.status, mood, ", ".join(message) or "no change")


def _parts(comparison: Comparison) -> list[Part]:
    """The tables below the matrix; one without rows is left out."""
    found = (
        ("worse", "Worse", listing.CHANGE_HEADS, listing.change_rows(comparison.worse)),
        ("better", "Better", listing.CHANGE_HEADS, listing.change_rows(comparison.better)),
        (
            "vanished",
            "Vanished: in the first record alone",
            listing.PRESENCE_HEADS,
            listing.presence_rows(comparison.vanished),
        ),
        (
            "appeared",
            "Appeared: in the second record alone",
            listing.PRESENCE_HEADS,
            listing.presence_rows(comparison.appeared),
        ),
        (
            "settings",
            "Different settings",
            ("what", *listing.SETTING_HEADS[1:]),
            listing.setting_rows(comparison),
        ),
        (
            "cost",
            "Time per step, second over first",
            listing.COST_HEADS,
            listing.cost_rows(comparison),
        ),
    )
    return [
        Part(anchor, title, heads, rows[:_ROWS_SHOWN], max(0, len(rows) - _ROWS_SHOWN))
        for anchor, title, heads, rows in found
        if rows
    ]
