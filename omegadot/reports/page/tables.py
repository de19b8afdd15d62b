"""The page's tables as plain rows of cells: every number, also for readers without script."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, NamedTuple

import polars as pl

from omegadot.reports.charts.deviations import Chart
from omegadot.reports.record.schema import GATES
from omegadot.reports.summary.provenance import Sources
from omegadot.reports.summary.summary import task_status
from omegadot.reports.text.numbers import engine_name, knob, short

CHANNEL_NAMES = {
    "omega_dot": "omega-dot",
    "omega": "omega",
    "attitude": "attitude",
    "energy": "energy",
    "angular_momentum": "angular momentum",
    "linear_momentum": "linear momentum",
    "position": "position",
    "torque": "torque",
    "model": "model",
    "time": "time",
}
# One value an engine, whatever it is stepped with; the others are one value a run.
ENGINE_GATES = ("model", "equation")
_PLAIN_NUMBERS = ("scheme", "cost")
_ENGINE = ["engine", "engine_version", "setup"]
_RUN = [*_ENGINE, "integrator", "timestep", "accuracy"]


class Value(NamedTuple):
    """One cell: its text, and "fail" or "declared" where it must stand out."""

    text: str
    mark: str = ""


@dataclass(frozen=True)
class Row:
    """heads: the cells that name the row.  values: the cells below the columns.  source: the
    number of their source, where that is known.
    """

    heads: tuple[str, ...]
    values: tuple[Value, ...]
    source: int | None = None


@dataclass(frozen=True)
class Table:
    """groups: (title, how many columns) of the upper head row.  columns: the lower head row."""

    heads: tuple[str, ...]
    groups: tuple[tuple[str, int], ...]
    columns: tuple[str, ...]
    rows: tuple[Row, ...]


EMPTY = Value("")


def unit_text(unit: str, gate: str = "") -> str:
    """How a unit stands behind a name: a pure number is a relative error, or an order or factor."""
    if unit == "1":
        return "" if gate in _PLAIN_NUMBERS else "relative"
    return unit


def engine_table(metrics: pl.DataFrame, sources: Sources | None = None) -> Table:
    """Model and equation, one row an engine: the worst value over its runs."""
    own = metrics.filter(pl.col("gate").is_in(ENGINE_GATES))
    return _pivot(own, _ENGINE, _engine_heads, sources or Sources())


def run_table(
    metrics: pl.DataFrame, tasks: Iterable[Mapping[str, Any]], sources: Sources | None = None
) -> Table:
    """What each run came to, one row a run, with its verdict and the reason of it."""
    sources = sources or Sources()
    # A match stands under the channel that is farthest off; here it has a column of its own.
    whole = pl.when(pl.col("metric") == "match").then(pl.lit("")).otherwise(pl.col("channel"))
    own = metrics.filter(~pl.col("gate").is_in(ENGINE_GATES)).with_columns(channel=whole)
    table = _pivot(own, _RUN, run_heads, sources)
    left = {row.heads: row for row in table.rows}
    blank = (EMPTY,) * len(table.columns)
    rows = []
    for task in tasks:
        names = run_heads(tuple(task.get(name) for name in _RUN))
        status = task_status(task)
        reason = task.get("why") or task.get("reason") or ""
        mark = status if status in ("fail", "declared") else ""
        found = left.pop(names).values if names in left else blank
        cells = (Value(status, mark), *found, Value(reason))
        rows.append(Row(names, cells, sources.number(task)))
    rows += [replace(row, values=(EMPTY, *row.values, EMPTY)) for row in left.values()]
    groups = (("outcome", 1), *table.groups, ("reason", 1))
    return Table(("engine", "run"), groups, ("verdict", *table.columns, "why"), tuple(rows))


def deviation_table(chart: Chart, sources: Sources | None = None) -> Table:
    """The numbers behind a scenario's charts: each run's largest error, and its last."""
    sources = sources or Sources()
    rows = [
        Row(
            run_heads((c.engine, "", c.setup, c.integrator, c.timestep, c.accuracy)),
            tuple(
                Value(short(value))
                for channel in chart.units
                for value in (c.largest[channel], c.end[channel])
            ),
            sources.number(vars(c)),
        )
        for c in chart.deviations
    ]
    groups = tuple(
        (f"{CHANNEL_NAMES[channel]}, {unit_text(unit)}", 2) for channel, unit in chart.units.items()
    )
    return Table(("engine", "run"), groups, ("largest", "at the end") * len(groups), tuple(rows))


def _engine_heads(key: tuple[Any, ...]) -> tuple[str, ...]:
    return (engine_name(*key),)


@lru_cache(maxsize=4096)
def run_heads(key: tuple[Any, ...]) -> tuple[str, ...]:
    """The cells that name a run: (engine, version, setup, integrator, step, accuracy) as text."""
    engine, _, setup, integrator, timestep, accuracy = key
    run = ", ".join(filter(None, (integrator, knob(timestep, accuracy))))
    return engine_name(engine, setup=setup), run


def _pivot(metrics: pl.DataFrame, heads: list[str], name: Any, sources: Sources) -> Table:
    """One row a key, one column a (gate, channel, metric, unit), each cell its worst row."""
    keys = ["gate", "channel", "metric", "unit"]
    # Runs and measures by number: comparing their names row by row would take most of the time.
    measures = metrics.select(keys).unique(maintain_order=True)
    order = sorted(range(len(measures)), key=lambda k: GATES.index(measures["gate"][k]))
    measures = measures[order].with_row_index("place")
    columns = measures.select(keys).rows()
    found = metrics.with_columns(run=pl.struct(heads).rle_id()).join(
        measures, on=keys, how="left", nulls_equal=True, maintain_order="left"
    )
    rows: dict[tuple[str, ...], list[Value]] = {}
    numbers: dict[tuple[str, ...], int] = {}
    weights: dict[tuple[str, ...], list[tuple[bool, float]]] = {}
    keyed = []
    for key in found.unique("run", keep="first", maintain_order=True).select(heads).rows():
        names = name(key)
        keyed.append(names)
        if names not in numbers:
            numbers[names] = sources.number(dict(zip(heads, key, strict=True)))
            rows[names] = [EMPTY] * len(columns)
            weights[names] = [(False, float("-inf"))] * len(columns)
    for at, place, value, bound, verdict in found.select(
        "run", "place", "value", "bound", "verdict"
    ).rows():
        names = keyed[at]
        weight = (verdict == "fail", float("inf") if value is None or value != value else value)
        if weights[names][place] <= weight:
            weights[names][place] = weight
            rows[names][place] = _value(value, bound, verdict)
    titles = [": ".join(filter(None, (g, CHANNEL_NAMES.get(c)))) for g, c, _, _ in columns]
    groups: list[tuple[str, int]] = []
    for title in titles:
        count = groups.pop()[1] if groups and groups[-1][0] == title else 0
        groups.append((title, count + 1))
    return Table(
        ("engine",),
        tuple(groups),
        tuple(_column_name(*column) for column in columns),
        tuple(Row(names, tuple(line), numbers[names]) for names, line in rows.items()),
    )


def _column_name(gate: str, _channel: str, metric: str, unit: str) -> str:
    return ", ".join(filter(None, (metric.replace("_", " "), unit_text(unit, gate))))


def _value(value: float | None, bound: float | None, verdict: str) -> Value:
    text = short(value)
    if verdict not in ("fail", "declared"):
        return Value(text)
    limit = "" if bound is None else f", bound {short(bound)}"
    return Value(f"{text} {'✗' if verdict == 'fail' else '!'} {verdict}{limit}", verdict)
