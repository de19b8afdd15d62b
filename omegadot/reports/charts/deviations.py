"""How far each run deviates from the exact solution, sample by sample: what the charts draw."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import polars as pl

from omegadot.reference_impl.system import Array
from omegadot.reports.charts.divergence import CHANNELS, STATE, divergence, system_from
from omegadot.reports.record.record import Record

# A run longer than this is thinned; each point is then the largest error since the last one.
POINTS = 120
_RUN = ("scenario", "engine", "setup", "integrator", "timestep", "accuracy")
_PREFERRED_TRUTH = ("closed-form", "series")


@dataclass(frozen=True)
class Series:
    """One run. time: (n,) s.  values: (n,) by channel, NaN where nothing could be measured.

    largest and end: over all stored samples, not only over the n that are drawn.
    """

    engine: str
    setup: str
    integrator: str
    timestep: float | None
    accuracy: float | None
    time: Array
    values: Mapping[str, Array]
    largest: Mapping[str, float]
    end: Mapping[str, float]


@dataclass(frozen=True)
class Chart:
    """A scenario's runs. units: by channel, only of those that matter here; "1" is relative to
    the largest value of the exact solution.  unmatched: samples without an exact one.
    """

    units: Mapping[str, str]
    deviations: tuple[Series, ...]
    unmatched: int


def chart_deviations(record: Record) -> dict[str, Chart]:
    """Every scenario's deviations, by name; one without an engine's trajectory is left out."""
    if record.trajectories.filter(pl.col("engine") != "exact").is_empty():
        return {}
    samples = _with_truth(record.trajectories)
    errors = np.full((len(samples), len(CHANNELS)), np.nan)
    units: dict[str, dict[str, str]] = {}
    names = samples.get_column("scenario")
    starts = np.flatnonzero((names != names.shift(1)).fill_null(value=True).to_numpy())
    systems = {entry["name"]: entry.get("system") for entry in record.run["scenarios"]}
    for start, stop in zip(starts, [*starts[1:], len(samples)], strict=True):
        name = names[int(start)]
        if systems.get(name):
            part = samples[int(start) : int(stop)]
            errors[start:stop], units[name] = divergence(system_from(systems[name]), part)
    measured = samples.select(*_RUN, "run", "time", "matched").with_columns(
        pl.Series(channel, errors[:, k]) for k, channel in enumerate(CHANNELS)
    )
    return _charts(measured, units)


def _with_truth(trajectories: pl.DataFrame) -> pl.DataFrame:
    """Every engine's samples with the exact solution's at the same time, sorted by run."""
    exact = pl.col("engine") == "exact"
    rank = pl.col("integrator").replace_strict(
        list(_PREFERRED_TRUTH), [0, 1], default=2, return_dtype=pl.Int64
    )
    truth = (
        trajectories.filter(exact)
        .sort(rank, maintain_order=True)
        .unique(["scenario", "time"], keep="first", maintain_order=True)
        .select("scenario", "time", *STATE, matched=pl.lit(value=True))
    )
    others = trajectories.filter(~exact)
    runs = others.select(_RUN).unique(maintain_order=True).with_row_index("run")
    order = others.select("scenario").unique(maintain_order=True).with_row_index("place")
    return (
        others.join(runs, on=_RUN, nulls_equal=True, how="left")
        .join(order, on="scenario", how="left")
        .join(truth, on=["scenario", "time"], how="left", suffix="_exact")
        .sort("place", "run", "time", maintain_order=True)
        .with_columns(pl.col("matched").fill_null(value=False))
    )


def _charts(measured: pl.DataFrame, units: Mapping[str, dict[str, str]]) -> dict[str, Chart]:
    index, count = pl.int_range(pl.len()).over("run"), pl.len().over("run")
    thinned = pl.when(count > POINTS).then(
        (index * (POINTS - 1) / (count - 1).clip(1)).ceil().cast(pl.Int64)
    )
    channels = [pl.col(channel) for channel in CHANNELS]
    points = (
        measured.with_columns(point=thinned.otherwise(index))
        .with_columns(column.fill_nan(None) for column in channels)
        .group_by("run", "point", maintain_order=True)
        .agg(pl.col("time").last(), *(column.max() for column in channels))
    )
    runs = measured.group_by("run", maintain_order=True).agg(
        *(pl.col(name).first() for name in _RUN),
        (~pl.col("matched")).sum().alias("unmatched"),
        *(_largest(channel).alias("largest_" + channel) for channel in CHANNELS),
        *(
            pl.col(channel).filter(pl.col("matched")).last().alias("end_" + channel)
            for channel in CHANNELS
        ),
    )
    times = points.get_column("time").to_numpy()
    values = points.select(CHANNELS).fill_null(float("nan")).to_numpy()
    stops = np.cumsum(points.group_by("run", maintain_order=True).len().get_column("len"))
    grouped: dict[str, list[tuple[Series, int]]] = {}
    for row, start, stop in zip(runs.iter_rows(named=True), [0, *stops[:-1]], stops, strict=True):
        deviation = Series(
            **{name: row[name] for name in _RUN[1:]},
            time=times[start:stop],
            values={c: values[start:stop, k] for k, c in enumerate(CHANNELS)},
            largest={c: row["largest_" + c] for c in CHANNELS},
            end={c: row["end_" + c] for c in CHANNELS},
        )
        grouped.setdefault(row["scenario"], []).append((deviation, row["unmatched"]))
    return {
        name: Chart(units.get(name, {}), tuple(c for c, _ in entries), sum(u for _, u in entries))
        for name, entries in grouped.items()
    }


def _largest(channel: str) -> pl.Expr:
    """NaN where any sample with an exact one is: such a run has no largest error."""
    column = pl.col(channel).filter(pl.col("matched"))
    return pl.when(column.is_nan().any()).then(float("nan")).otherwise(column.max())
