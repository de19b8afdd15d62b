"""The page's tables as plain rows of cells: every number, also for readers without script."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import groupby
from typing import Any, NamedTuple

import polars as pl

from omegadot.reports.charts.deviations import Chart
from omegadot.reports.record.schema import GATES
from omegadot.reports.summary.provenance import Sources
from omegadot.reports.summary.reasons import failing_gates, reason_of
from omegadot.reports.summary.summary import task_status
from omegadot.reports.text.metric_names import metric_name
from omegadot.reports.text.numbers import engine_name, knob, short

# One value an engine, whatever it is stepped with; the others are one value a run.
ENGINE_GATES = ("model", "equation")
# Of the exact solution, and so one value a scenario.
FLOOR_METRIC = "resolvable_floor"
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


def channel_name(channel: str) -> str:
    """A channel in plain English."""
    return "omega-dot" if channel == "omega_dot" else channel.replace("_", " ")


def unit_text(unit: str, gate: str = "") -> str:
    """How a unit stands behind a name: a pure number is a relative error, or an order or factor."""
    if unit == "1":
        return "" if gate in _PLAIN_NUMBERS else "relative"
    return unit


def engine_table(metrics: pl.DataFrame, sources: Sources) -> Table:
    """Model and equation, one row an engine: the worst value over its runs."""
    own = metrics.filter(pl.col("gate").is_in(ENGINE_GATES))
    return _pivot(own, _ENGINE, _engine_heads, sources)


def run_table(metrics: pl.DataFrame, tasks: Iterable[Mapping[str, Any]], sources: Sources) -> Table:
    """What each run came to, one row a run, with its verdict and the reason of it.

    The gates that fail are named: model and equation, which the runs share, have no column here.
    """
    # A match stands under the channel that is farthest off; here it has a column of its own.
    whole = pl.when(pl.col("metric") == "match").then(pl.lit("")).otherwise(pl.col("channel"))
    of_runs = ~pl.col("gate").is_in(ENGINE_GATES) & (pl.col("metric") != FLOOR_METRIC)
    own = metrics.filter(of_runs).with_columns(channel=whole)
    table = _pivot(own, _RUN, run_heads, sources)
    left = {row.heads: row for row in table.rows}
    blank = (EMPTY,) * len(table.columns)
    rows = []
    for task in tasks:
        names = run_heads(tuple(task.get(name) for name in _RUN))
        status = task_status(task)
        mark = status if status in ("fail", "declared") else ""
        verdict = ": ".join(filter(None, (status, ", ".join(failing_gates(task)))))
        found = left.pop(names).values if names in left else blank
        cells = (Value(verdict, mark), *found, Value(reason_of(task)))
        rows.append(Row(names, cells, sources.number(task)))
    rows += [replace(row, values=(EMPTY, *row.values, EMPTY)) for row in left.values()]
    groups = (("outcome", 1), *table.groups, ("reason", 1))
    return Table(("engine", "run"), groups, ("verdict", *table.columns, "why"), tuple(rows))


def floors_text(metrics: pl.DataFrame) -> str:
    """The floors of a scenario, channel by channel; empty where none is known."""
    rows = metrics.filter(pl.col("metric") == FLOOR_METRIC).select("channel", "value", "unit")
    return ", ".join(
        f"{channel_name(channel)} {short(value)} {unit_text(unit)}".rstrip()
        for channel, value, unit in rows.iter_rows()
    )


def deviation_table(chart: Chart, sources: Sources) -> Table:
    """The numbers behind a scenario's charts: each run's largest error, and its last."""
    rows = []
    for run in chart.deviations:
        heads = run_heads((run.engine, "", run.setup, run.integrator, run.timestep, run.accuracy))
        numbers = (number for c in chart.units for number in (run.largest[c], run.end[c]))
        values = tuple(Value(short(number)) for number in numbers)
        rows.append(Row(heads, values, sources.number(vars(run))))
    groups = tuple(
        (f"{channel_name(channel)}, {unit_text(unit)}", 2) for channel, unit in chart.units.items()
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
    columns = metrics.select(keys).unique(maintain_order=True).rows()
    columns.sort(key=lambda column: GATES.index(column[0]))
    numbers: dict[tuple[str, ...], int] = {}
    for key in metrics.select(heads).unique(maintain_order=True).rows():
        names = name(key)
        if names not in numbers:
            numbers[names] = sources.number(dict(zip(heads, key, strict=True)))
    # The worst comes last and stays: a failure, and there the largest value.
    size = pl.col("value").fill_nan(float("inf")).fill_null(float("inf"))
    ordered = metrics.sort(pl.col("verdict") == "fail", size, maintain_order=True)
    place = {column: k for k, column in enumerate(columns)}
    cells: dict[tuple[str, ...], list[Any]] = {names: [None] * len(columns) for names in numbers}
    for row in ordered.select(*heads, *keys, "value", "bound", "verdict").iter_rows():
        cells[name(row[:-7])][place[row[-7:-3]]] = row[-3:]
    titles = [": ".join(filter(None, (g, channel_name(c)))) for g, c, _, _ in columns]
    return Table(
        ("engine",),
        tuple((title, len(list(group))) for title, group in groupby(titles)),
        tuple(
            ", ".join(filter(None, (metric_name(metric), unit_text(unit, gate))))
            for gate, _, metric, unit in columns
        ),
        tuple(
            Row(names, tuple(map(_value, cells[names])), number)
            for names, number in numbers.items()
        ),
    )


def _value(figure: tuple[Any, ...] | None) -> Value:
    if figure is None:
        return EMPTY
    value, bound, verdict = figure
    text = short(value)
    if verdict not in ("fail", "declared"):
        return Value(text)
    limit = "" if bound is None else f", bound {short(bound)}"
    return Value(f"{text} {'✗' if verdict == 'fail' else '!'} {verdict}{limit}", verdict)
