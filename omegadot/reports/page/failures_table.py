"""The page's table of failures: what a reader should look at first comes first, with its cause."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Any

import polars as pl

from omegadot.reports.page.tables import channel_name, unit_text
from omegadot.reports.record.record import Record
from omegadot.reports.record.schema import GATES
from omegadot.reports.summary.failed_gate import excess, over_bound, worst_row
from omegadot.reports.summary.provenance import Sources
from omegadot.reports.summary.reasons import cause_of
from omegadot.reports.summary.summary import Column, column_of
from omegadot.reports.text.metric_names import measure_name, metric_name
from omegadot.reports.text.numbers import engine_name, first, knob, quantity, times

MOST = 40  # rows on the page; every engine has its share of them, and three at least
_FEWEST = 3
MOST_BESIDE = 2  # measures of a row that are named beside its worst
_RUN = ("integrator", "timestep", "accuracy")
Row = Mapping[str, Any]


@dataclass(frozen=True)
class Failure:
    """A gate of an engine that fails on a scenario, or that fails as declared.

    measure and size: its worst measure, with others; how many times its bound that is.  cause: the
    likely one, where it is known.  run: the worst, with how many there are.
    """

    verdict: str
    engine: str
    gate: str
    scenario: str
    measure: str
    size: str
    cause: str
    run: str
    note: str
    source: int


def failures_table(
    record: Record, columns: Iterable[Column], sources: Sources
) -> tuple[list[Failure], int]:
    """The rows to show, and how many more there are.

    Failures come before declared exceptions; then engine by engine in the order of the `columns`;
    of one, the first gate first, as later ones fail for the same reason; then by size over bound.
    """
    found = [(worst_row(rows), rows) for rows in _by_gate(record.metrics)]
    places = {(c.engine, c.version, c.setup): place for place, c in enumerate(columns)}
    found.sort(
        key=lambda pair: (
            pair[0]["verdict"] != "fail",
            places.get(_engine_of(pair[0]), len(places)),
            GATES.index(pair[0]["gate"]),
            -excess(pair[0]),
        )
    )
    causes, kept = _causes(record.run["tasks"]), _shares([worst for worst, _ in found])
    shown = [_failure(*found[place], causes, sources) for place in kept]
    return shown, len(found) - len(shown)


def _by_gate(metrics: pl.DataFrame) -> list[list[Row]]:
    """The rows that fail or fail as declared, of each gate of an engine on a scenario."""
    found: dict[tuple[str, ...], list[Row]] = {}
    for row in metrics.filter(pl.col("verdict").is_in(["fail", "declared"])).iter_rows(named=True):
        key = (row["verdict"], row["scenario"], row["gate"], *_engine_of(row))
        found.setdefault(key, []).append(row)
    return list(found.values())


def _shares(rows: Sequence[Row]) -> list[int]:
    """Of rows in order the places of those that are shown: no failing engine hides another."""
    counts = dict.fromkeys(map(_engine_of, rows), 0)
    share = max(_FEWEST, MOST // max(1, len(counts)))
    shown = []
    for place, row in enumerate(rows):
        counts[_engine_of(row)] += 1
        if counts[_engine_of(row)] <= share:
            shown.append(place)
    return shown


def _engine_of(row: Row) -> tuple[str, str, str]:
    return row["engine"], row["engine_version"], row["setup"]


def _causes(tasks: Iterable[Row]) -> dict[tuple[Any, ...], str]:
    """The likely cause by what names a task; by scenario and engine that of its first failure."""
    found: dict[tuple[Any, ...], str] = {}
    for task in tasks:
        if cause := cause_of(task):
            whole = (task["scenario"], *column_of(task))
            found.setdefault((*whole, None, None, None), cause)
            found.setdefault((*whole, *map(task.get, _RUN)), cause)
    return found


def _size(row: Row) -> str:
    """How many times its bound, and the value itself where it is no share of a bound."""
    text = over_bound(row)
    if row["bound"] == 1.0 or not text.endswith("bound") or not isfinite(row["value"]):
        return text
    return f"{text} ({quantity(row['value'], unit_text(row['unit'], row['gate']) or '1')})"


def _failure(
    worst: Row, rows: Sequence[Row], causes: Mapping[tuple[Any, ...], str], sources: Sources
) -> Failure:
    measures = {(row["channel"], row["metric"]) for row in rows}
    stepped = [row for row in rows if row["timestep"] or row["accuracy"]]  # no order of a sweep
    runs = {tuple(row[key] for key in _RUN) for row in stepped}
    names = {one: measure_name(channel_name(one[0]), metric_name(one[1])) for one in measures}
    measure = names.pop((worst["channel"], worst["metric"]))
    others = f"; also {first(sorted(set(names.values())), MOST_BESIDE)}" if names else ""
    run = (worst["integrator"], knob(worst["timestep"], worst["accuracy"]))
    count = times(len(runs), "run") if runs else ""
    key = (worst["scenario"], *_engine_of(worst), *(worst[name] for name in _RUN))
    return Failure(
        worst["verdict"],
        engine_name(*_engine_of(worst)),
        worst["gate"],
        worst["scenario"],
        measure + others,
        _size(worst),
        causes.get(key, ""),
        "; ".join(filter(None, (", ".join(filter(None, run)), count))),
        worst["note"] or "",
        sources.number(worst),
    )
