"""The change of the time per step between two records: reported with its spread, never judged."""

from __future__ import annotations

from dataclasses import dataclass

import polars as pl

from omegadot.reports.two_runs.change import name_of
from omegadot.reports.two_runs.sides import RunKey, Side, tasks_of


@dataclass(frozen=True)
class Cost:
    """Time per step now over that before, over the runs that both records timed.

    median; low and high: quartiles.  runs: how many there are.
    """

    engine: str
    integrator: str
    median: float
    low: float
    high: float
    runs: int


def costs(was: Side, now: Side, versioned: set[str]) -> list[Cost]:
    """One entry an engine and integrator, in the order of the second record."""
    then, today = (_times(side, versioned) for side in (was, now))
    ratios: dict[RunKey, list[float]] = {}
    for key, time in today.items():
        if then.get(key, 0.0) > 0.0 and time > 0.0:
            lane = key._replace(scenario="", timestep=None, accuracy=None)
            ratios.setdefault(lane, []).append(time / then[key])
    found = []
    for key, own in ratios.items():
        series = pl.Series(own)
        low, high = (float(series.quantile(q, "linear") or 0.0) for q in (0.25, 0.75))
        median = float(series.median() or 0.0)  # type: ignore[arg-type]
        found.append(Cost(name_of(key), key.integrator, median, low, high, len(own)))
    return found


def _times(side: Side, versioned: set[str]) -> dict[RunKey, float]:
    """S of wall time per step, by run."""
    known = tasks_of(side, versioned)
    rows = side.record.metrics.filter(
        (pl.col("metric") == "time_per_step") & pl.col("value").is_finite()
    )
    names = ("scenario", "engine", "engine_version", "setup", "integrator", "timestep", "accuracy")
    found = {}
    for scenario, engine, version, setup, integrator, step, accuracy, value in rows.select(
        *names, "value"
    ).iter_rows():
        own = version if engine in versioned else ""
        key = RunKey(scenario, engine, own, setup, integrator or "", step, accuracy)
        if key in known:
            found[key] = value
    return found
