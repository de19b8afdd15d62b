"""How error and cost go with the step: the points of convergence and work-precision charts."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import polars as pl

from omegadot.reference_impl.system import Array
from omegadot.reports.charts.coinciding import sweep_leaders
from omegadot.reports.charts.packing import CEILING_DECADE, FLOOR, rounded
from omegadot.reports.summary.provenance import Sources

# A guide of the declared order stands this much above the errors that it goes with.
ABOVE = 2.0
# No attitude is farther than half a turn from another.
FARTHEST = math.pi


@dataclass(frozen=True)
class Point:
    """One run. error: rad, the attitude's largest, None where it is not finite.  bound: rad, how
    far rounding may take it.  cost: s of wall time per simulated second, None where not measured.
    """

    timestep: float
    error: float | None
    bound: float | None
    cost: float | None


@dataclass(frozen=True)
class Sweep:
    """The runs of one integrator, the finest step first. order: the declared one, if any."""

    engine: str
    setup: str
    integrator: str
    order: float | None
    points: tuple[Point, ...]


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None


def sweeps_of(metrics: pl.DataFrame) -> dict[str, list[Sweep]]:
    """Every scenario's sweeps, by name, from the measured attitude errors and times per step."""
    names = ("scenario", "engine", "setup", "integrator", "timestep", "channel", "metric")
    rows = metrics.filter(
        pl.col("timestep").is_not_null()
        & pl.col("integrator").is_not_null()
        & pl.col("metric").is_in(["error_max", "observed_order", "time_per_step"])
    )
    runs: dict[tuple[str, ...], dict[float, dict[str, float | None]]] = {}
    for *lane, step, channel, metric, value, bound in rows.select(
        *names, "value", "bound"
    ).iter_rows():
        found = {
            ("attitude", "error_max"): {"error": value, "bound": bound},
            ("attitude", "observed_order"): {"order": bound},
            ("time", "time_per_step"): {"cost": value},
        }.get((channel, metric))
        if found is not None:
            runs.setdefault(tuple(lane), {}).setdefault(step, {}).update(found)
    sweeps: dict[str, list[Sweep]] = {}
    for (scenario, engine, setup, integrator), by_step in runs.items():
        points = tuple(_point(step, by_step[step]) for step in sorted(by_step))
        order = next((f["order"] for f in by_step.values() if f.get("order") is not None), None)
        sweeps.setdefault(scenario, []).append(Sweep(engine, setup, integrator, order, points))
    return sweeps


def _point(step: float, found: Mapping[str, float | None]) -> Point:
    error, bound, cost = (_finite(found.get(name)) for name in ("error", "bound", "cost"))
    return Point(step, error, bound, None if cost is None else cost / step)


def guides(sweeps: Iterable[Sweep]) -> list[list[float]]:
    """``[order, h0, e0, h1, e1]``: a line of each declared order, above the errors that show it.

    Anchored at the largest error of that order at the finest step; none where it is rounding, or
    where the line would start beyond half a turn.
    """
    anchors: dict[float, tuple[float, float, float]] = {}
    for sweep in sweeps:
        points = [p for p in sweep.points if p.error and p.error > (p.bound or 0.0)]
        if sweep.order is None or len(points) < 2:
            continue
        first, last = points[0], points[-1]
        error = ABOVE * (first.error or 0.0)
        if error < FARTHEST and error > anchors.get(sweep.order, (0.0, 0.0, 0.0))[1]:
            anchors[sweep.order] = (first.timestep, error, last.timestep)
    found = []
    for order, (step, error, last_step) in sorted(anchors.items()):
        end = min(last_step, step * (FARTHEST / error) ** (1.0 / order)) if order else last_step
        found.append([order, step, error, end, error * (end / step) ** order])
    return found


def rounding(sweeps: Iterable[Sweep]) -> list[list[float]]:
    """``[h, bound]``: how far rounding may take the attitude, the largest of all integrators."""
    largest: dict[float, float] = {}
    for sweep in sweeps:
        for point in sweep.points:
            if point.bound is not None and point.bound < FARTHEST:
                largest[point.timestep] = max(point.bound, largest.get(point.timestep, 0.0))
    return [[step, bound] for step, bound in sorted(largest.items())]


def decades(values: Array) -> dict[str, Any]:
    """The decades that hold all values, and whether any of them lies at the floor or below."""
    above = values[values > FLOOR]
    high = min(float(np.max(above, initial=FLOOR * 10.0)), 10.0**CEILING_DECADE)
    at_floor = len(above) < len(values)
    low = FLOOR if at_floor else float(np.min(above, initial=high))
    return {
        "low": math.floor(math.log10(low)),
        "high": math.ceil(math.log10(high)),
        "floor": at_floor,
    }


def sweep_payload(
    sweeps: list[Sweep],
    places: Mapping[tuple[str, str, str], int],
    sources: Sources,
    floor: float = 0.0,
) -> dict[str, Any]:
    """What the script draws: ``[line, [[h, error, cost, source], ...], leader]`` an integrator,
    guides, axis.

    leader: the place of the first with the same errors over the step.
    floor: rad, below which attitude errors cannot be distinguished; 0 where it is unknown.
    """
    drawn = [s for s in sweeps if (s.engine, s.setup, s.integrator) in places]
    errors = [p.error for sweep in sweeps for p in sweep.points if p.error is not None]
    axis = decades(np.array(errors + ([floor] if floor else [])))
    by_step = [{p.timestep: p.error for p in sweep.points} for sweep in drawn]
    led = sweep_leaders(by_step, axis["high"] - axis["low"])
    lines = [
        [
            places[sweep.engine, sweep.setup, sweep.integrator],
            [_drawn(sweep, point, sources) for point in sweep.points],
            leader,
        ]
        for sweep, leader in zip(drawn, led, strict=True)
    ]
    return {
        "lines": lines,
        "guides": [[rounded(value) for value in guide] for guide in guides(sweeps)],
        "rounding": [[step, rounded(bound)] for step, bound in rounding(sweeps)],
        "resolvable": rounded(floor) if floor else None,
        **axis,
    }


def _drawn(sweep: Sweep, point: Point, sources: Sources) -> list[float | None]:
    number = sources.number(vars(sweep) | vars(point))
    return [point.timestep, rounded(point.error), rounded(point.cost), number]
