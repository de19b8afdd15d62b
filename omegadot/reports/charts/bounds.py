"""What the charts' bounds and floors are: read from the measures, run by run."""

from __future__ import annotations

import math
from bisect import insort
from dataclasses import dataclass, field
from typing import Any

import polars as pl

from omegadot.reports.charts.deviations import Series
from omegadot.reports.text.numbers import magnitude

# The fraction of a run up to which each of an invariant's bounds holds.
HORIZONS = {"drift_quarter": 0.25, "drift_half": 0.5, "drift_full": 1.0}
# From here on a bound allows everything: half a turn, or the whole of a relative quantity.
WITHOUT_MEANING = {"attitude": math.pi}
_RUN = ("engine", "setup", "integrator", "timestep", "accuracy")

RunKey = tuple[Any, ...]
Steps = list[tuple[float, float]]
Judged = tuple[float | None, float | None]
_NONE: Judged = (None, None)
# Recorded relative to the exact motion's sizes, and drawn only where the chart is relative too.
_RELATIVE = ("energy", "angular_momentum", "linear_momentum")


@dataclass(frozen=True)
class Limits:
    """What may be drawn into a scenario's charts with the errors.

    bounds: by run (engine, setup, integrator, step, accuracy) and channel, how far rounding may
    take the error: ``(fraction, bound)``, fraction of the run's length up to which it holds.
    floors: by channel, the uncertainty of the exact solution.
    """

    bounds: dict[RunKey, dict[str, Steps]] = field(default_factory=dict)
    floors: dict[str, float] = field(default_factory=dict)

    def bound(self, deviation: Series, channel: str, unit: str) -> Steps:
        """The bounds of one run in one chart; none where they have another unit."""
        if channel in _RELATIVE and unit != "1":
            return []
        run = tuple(getattr(deviation, name) for name in _RUN)
        return list(self.bounds.get(run, {}).get(channel, []))

    def floor(self, channel: str, unit: str) -> float | None:
        """The floor of one chart; None where none is known in its unit."""
        return None if channel in _RELATIVE and unit != "1" else self.floors.get(channel)


def floor_of(limits: Limits) -> float:
    """rad: the attitude error below which runs cannot be distinguished; 0 where it is unknown."""
    return limits.floors.get("attitude", 0.0)


@dataclass(frozen=True)
class Residual:
    """An engine's omega-dot residuals at identical states: the worst at random states and along
    the exact trajectory, each with its bound; relative to the terms of equation (8) by size.
    """

    engine: str
    version: str
    setup: str
    random: Judged
    path: Judged


def limits_of(metrics: pl.DataFrame) -> dict[str, Limits]:
    """The limits of every scenario that has any.

    Bounds that are not finite, or allow everything, are left out. So are floors that are not
    recorded: an error below a floor cannot be distinguished from zero, as a perfect answer in
    double is that far off.
    """
    found: dict[str, Limits] = {}
    invariant = (pl.col("gate") == "invariants") & pl.col("metric").is_in(list(HORIZONS))
    attitude = (pl.col("channel") == "attitude") & (pl.col("metric") == "error_max")
    bounded = metrics.filter(
        pl.col("bound").is_finite()
        & pl.col("integrator").is_not_null()
        & (invariant | ((pl.col("gate") == "trajectory") & attitude))
    )
    columns = bounded.select("scenario", *_RUN, "channel", "metric", "bound")
    for scenario, *run, channel, metric, bound in columns.iter_rows():
        if 0.0 < bound < WITHOUT_MEANING.get(channel, 1.0):
            own = found.setdefault(scenario, Limits()).bounds.setdefault(tuple(run), {})
            insort(own.setdefault(channel, []), (HORIZONS.get(metric, 1.0), bound))
    rows = metrics.filter((pl.col("metric") == "resolvable_floor") & (pl.col("value") > 0.0))
    for scenario, channel, value in rows.select("scenario", "channel", "value").iter_rows():
        if math.isfinite(value):
            found.setdefault(scenario, Limits()).floors[channel] = value
    return found


def residuals_of(metrics: pl.DataFrame) -> dict[str, list[Residual]]:
    """By scenario: every engine's omega-dot residuals, in the order of the record."""
    rows = metrics.filter((pl.col("gate") == "equation") & (pl.col("channel") == "omega_dot"))
    worst: dict[str, dict[tuple[str, str, str], dict[str, Judged]]] = {}
    names = ("scenario", "engine", "engine_version", "setup", "metric", "value", "bound")
    for scenario, engine, version, setup, metric, value, bound in rows.select(names).iter_rows():
        own = worst.setdefault(scenario, {}).setdefault((engine, version, setup), {})
        value = value if value is None or math.isfinite(value) else None
        if metric not in own or magnitude(value) > magnitude(own[metric][0]):
            own[metric] = (value, bound)
    return {
        scenario: [
            Residual(*key, own.get("residual", _NONE), own.get("residual_on_path", _NONE))
            for key, own in engines.items()
        ]
        for scenario, engines in worst.items()
    }
