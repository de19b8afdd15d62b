"""The few numbers that stand for an engine on a scenario, each with the run that gave it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import polars as pl

from omegadot.reports.summary.plain import PLAIN
from omegadot.reports.text.numbers import magnitude, times_its_bound

_SUMMARISED = (
    ((pl.col("gate") == "equation") & (pl.col("channel") == "omega_dot"))
    | ((pl.col("gate") == "invariants") & (pl.col("channel") == "angular_momentum"))
    | ((pl.col("gate") == "trajectory") & (pl.col("channel") == "attitude"))
)
_METRIC = {"omega_dot": "residual", "angular_momentum": "drift", "attitude": "error"}
_COPIED = ("unit", "scenario", "engine", "metric", "timestep", "accuracy", "bound")

Key = tuple[str, str, str, str]


@dataclass(frozen=True)
class Figure:
    """One number and the run that gave it. A value that is not finite counts as the largest."""

    value: float
    unit: str
    scenario: str
    engine: str
    metric: str
    integrator: str | None = None
    timestep: float | None = None
    accuracy: float | None = None
    bound: float | None = None


@dataclass(frozen=True)
class Range:
    """The best and the worst integrator of an engine, each at the finest step it was run with.

    all: of every integrator.
    """

    best: Figure
    worst: Figure
    all: tuple[Figure, ...] = ()


def size(figure: Figure) -> float:
    """Its magnitude, for ordering: what is not a number is larger than any number."""
    return magnitude(figure.value)


def excess_of(figure: Figure) -> float:
    """How many times its bound it is; 0 where it has none."""
    return times_its_bound(figure.value, figure.bound) if figure.bound else 0.0


def worst_residual(figures: Iterable[Figure]) -> Figure | None:
    """The one that every table shows; None of none.

    Of the plain ones that are above their bound, that which is so by the most, as where a failure
    is stated; else of the others; where all hold, the largest.
    """
    found = list(figures)
    over = [figure for figure in found if excess_of(figure) > 1.0]
    plain = [figure for figure in over if figure.metric in PLAIN]
    return max(plain or over, key=excess_of, default=max(found, key=size, default=None))


def range_of(figures: list[Figure]) -> Range | None:
    """Best and worst integrator, each at its finest step and there at its largest value."""
    runs: dict[str, dict[float, Figure]] = {}
    for figure in figures:
        step = figure.timestep if figure.timestep is not None else figure.accuracy
        at_step = runs.setdefault(figure.integrator or "", {})
        present = at_step.get(step or 0.0)
        if present is None or size(figure) > size(present):
            at_step[step or 0.0] = figure
    finest = [steps[min(steps)] for steps in runs.values()]
    if not finest:
        return None
    return Range(min(finest, key=size), max(finest, key=size), tuple(finest))


def figures_of(metrics: pl.DataFrame) -> dict[Key, dict[str, list[Figure]]]:
    """By engine and scenario, and there by channel: what the summary shows of the metrics."""
    found: dict[Key, dict[str, list[Figure]]] = {}
    for row in metrics.filter(_SUMMARISED).iter_rows(named=True):
        if not row["metric"].startswith(_METRIC[row["channel"]]):
            continue
        key = (row["scenario"], row["engine"], row["engine_version"], row["setup"])
        figure = Figure(
            value=float("nan") if row["value"] is None else row["value"],
            integrator=row["integrator"] or None,
            **{name: row[name] for name in _COPIED},
        )
        found.setdefault(key, {}).setdefault(row["channel"], []).append(figure)
    return found
