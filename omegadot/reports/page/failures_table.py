"""The page's table of failures: what a reader should look at first comes first, with its cause."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import polars as pl

from omegadot.reports.page.tables import channel_name, unit_text
from omegadot.reports.record.record import Record
from omegadot.reports.record.schema import GATES
from omegadot.reports.summary.failed_gate import excess
from omegadot.reports.summary.provenance import Sources
from omegadot.reports.summary.reasons import cause_of
from omegadot.reports.summary.summary import Column, column_of
from omegadot.reports.text.numbers import engine_name, knob, quantity, short

MOST = 50  # rows on the page; every engine has its share of them, and three at least
_FEWEST = 3
_MEASURE = ("verdict", "engine", "engine_version", "setup", "scenario", "gate", "channel", "metric")
_OF_TASK = ("scenario", "engine", "engine_version", "setup", "integrator", "timestep", "accuracy")


@dataclass(frozen=True)
class Failure:
    """A measure of an engine on a scenario that fails, or that fails as declared: its worst run.

    over: how many times its bound it is, with the bound.  cause: the likely one, where it is known.
    run: integrator and step.  runs: how many of its runs fail by that measure.
    """

    verdict: str
    engine: str
    gate: str
    scenario: str
    measure: str
    value: str
    over: str
    cause: str
    run: str
    runs: int
    note: str
    source: int


def failures_table(
    record: Record, columns: Iterable[Column], sources: Sources
) -> tuple[list[Failure], int]:
    """The rows to show, and how many more there are.

    Failures come before declared exceptions; then engine by engine in the order of the `columns`;
    of one, the first gate first, as later ones fail for the same reason; then by size over bound.
    """
    found = _measures(record.metrics)
    places = {(c.engine, c.version, c.setup): place for place, c in enumerate(columns)}
    found.sort(
        key=lambda row: (
            row["verdict"] != "fail",
            places.get(_engine_of(row), len(places)),
            GATES.index(row["gate"]),
            -excess(row),
        )
    )
    shown = _shares(found)
    causes = _causes(record.run["tasks"])
    return [_failure(row, causes, sources) for row in shown], len(found) - len(shown)


def _measures(metrics: pl.DataFrame) -> list[dict[str, Any]]:
    """The worst row of each measure that fails or fails as declared, with its count of rows."""
    rows = metrics.filter(pl.col("verdict").is_in(["fail", "declared"]))
    worst: dict[tuple[Any, ...], dict[str, Any]] = {}
    for row in rows.iter_rows(named=True):
        key = tuple(row[name] for name in _MEASURE)
        runs = worst[key]["runs"] + 1 if key in worst else 1
        if key not in worst or excess(row) > excess(worst[key]):
            worst[key] = row
        worst[key] |= {"runs": runs}
    return list(worst.values())


def _shares(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Of rows in order those that are shown: a failing engine hides no other."""
    engines: dict[tuple[str, str, str], int] = {}
    for row in rows:
        engines[_engine_of(row)] = 0
    share = max(_FEWEST, MOST // max(1, len(engines)))
    shown = []
    for row in rows:
        engines[_engine_of(row)] += 1
        if engines[_engine_of(row)] <= share:
            shown.append(row)
    return shown


def _engine_of(row: Mapping[str, Any]) -> tuple[str, str, str]:
    return row["engine"], row["engine_version"], row["setup"]


def _causes(tasks: Iterable[Mapping[str, Any]]) -> dict[tuple[Any, ...], str]:
    """The likely cause by what names a task; by scenario and engine that of its first failure."""
    found: dict[tuple[Any, ...], str] = {}
    for task in tasks:
        if cause := cause_of(task):
            whole = (task["scenario"], *column_of(task))
            run = task.get("integrator"), task.get("timestep"), task.get("accuracy")
            found.setdefault((*whole, None, None, None), cause)
            found.setdefault((*whole, *run), cause)
    return found


def _over(row: Mapping[str, Any]) -> str:
    """How many times its bound a value is, as text; the bound alone where that has no meaning."""
    bound, times = row["bound"], excess(row)
    if bound is None:
        return ""
    if times and math.isfinite(times):
        return f"{short(times)} × {short(bound)}"
    return f"{'declared' if row['metric'] == 'observed_order' else 'bound'} {short(bound)}"


def _failure(
    row: Mapping[str, Any], causes: Mapping[tuple[Any, ...], str], sources: Sources
) -> Failure:
    measure = f"{channel_name(row['channel'])} {row['metric'].replace('_', ' ')}"
    run = (row["integrator"], knob(row["timestep"], row["accuracy"]))
    return Failure(
        row["verdict"],
        engine_name(*_engine_of(row)),
        row["gate"],
        row["scenario"],
        measure,
        quantity(row["value"], unit_text(row["unit"], row["gate"]) or "1"),
        _over(row),
        causes.get(tuple(row[name] for name in _OF_TASK), ""),
        ", ".join(filter(None, run)),
        row["runs"],
        row["note"] or "",
        sources.number(row),
    )
