"""Synthetic records with one thing changed, to be compared with the record that they come from."""

from __future__ import annotations

import copy
from dataclasses import replace

import polars as pl

from omegadot.reports.summary.summary import summarise

SMALL = {"scenarios": ("sphere", "spun-again"), "steps": (0.02, 0.01), "samples": 4}
BOUND = 1e-13  # of every figure of a synthetic record but the orders
RUN = ("sphere", "mujoco", "RK4", 0.01)
FIGURE = ("trajectory", "attitude", "error_max")


def edited(record, run=RUN, figure=FIGURE, **columns):
    """The record with some columns of one figure set."""
    scenario, engine, integrator, step = run
    gate, channel, name = figure
    row = (
        (pl.col("scenario") == scenario)
        & (pl.col("engine") == engine)
        & pl.col("integrator").eq_missing(integrator)
        & pl.col("timestep").eq_missing(step)
        & (pl.col("gate") == gate)
        & (pl.col("channel") == channel)
        & (pl.col("metric") == name)
    )
    assert record.metrics.filter(row).height == 1
    new = [pl.when(row).then(pl.lit(v)).otherwise(pl.col(c)).alias(c) for c, v in columns.items()]
    return replace(record, metrics=record.metrics.with_columns(new))


def value_of(record, run=RUN, figure=FIGURE):
    names = dict(zip(("scenario", "engine", "integrator", "timestep"), run, strict=True))
    names |= dict(zip(("gate", "channel", "metric"), figure, strict=True))
    return record.metrics.filter(**names).get_column("value").item()


def with_run(record, **entries):
    return replace(record, run={**copy.deepcopy(record.run), **entries})


def with_tasks(record, change):
    """The record with each task changed, or dropped where `change` gives None."""
    tasks = [change(dict(entry)) for entry in record.run["tasks"]]
    return with_run(record, tasks=[entry for entry in tasks if entry is not None])


def only(record, keep):
    """The record of some runs alone."""
    rows = [keep(row) for row in record.metrics.iter_rows(named=True)]
    kept = with_tasks(record, lambda entry: entry if keep(entry) else None)
    return replace(kept, metrics=record.metrics.filter(pl.Series(rows)))


def cell(record, scenario, engine):
    """Of the summary's matrix."""
    summary = summarise(record)
    (column,) = [c for c in summary.columns if c.label == engine]
    return summary.cells[scenario, column]


def with_task(record, place, **more):
    """With other entries of one task."""
    tasks = [dict(entry) for entry in record.run["tasks"]]
    tasks[place].update(more)
    return with_run(record, tasks=tasks)


def first_of(record, engine):
    """The place of an engine's first task."""
    return next(k for k, entry in enumerate(record.run["tasks"]) if entry["engine"] == engine)
