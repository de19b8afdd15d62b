"""Which runs are drawn as one line, and which lines a chart shows before anything is selected."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence

import numpy as np

from omegadot.reference_impl.system import Array
from omegadot.reports.charts.deviations import Chart, Series
from omegadot.reports.charts.packing import CEILING_DECADE, FLOOR
from omegadot.reports.record.schema import YARDSTICKS
from omegadot.reports.text.numbers import magnitude

# Curves no farther apart than a line is broad cover each other: px, of a plot so many px high.
_BROAD, _HIGH = 2.0, 220.0
Lane = tuple[str, str, str]


def lane_of(run: Series) -> Lane:
    """Engine, setup and integrator: what one line of the page stands for."""
    return run.engine, run.setup, run.integrator


def leaders(
    runs: Sequence[Series], values: Sequence[Array], decades: float, floor: float | None
) -> list[int]:
    """By run: the place of the first run of the same step with which it coincides in one chart.

    values: what is drawn, (n,).  decades: the height of the axis.  floor: below it errors mean
    nothing, and no two are different.
    """
    least = max(FLOOR, floor or 0.0)
    height = max(1.0, decades) * _BROAD / _HIGH
    # The start, where nothing is drawn of a run without an error, is below the floor.
    drawn = [
        np.where((r.time == 0.0) & np.isnan(v), least, v) for r, v in zip(runs, values, strict=True)
    ]
    rows = [np.log10(np.clip(own, least, 10.0**CEILING_DECADE)) / height for own in drawn]
    found: list[int] = []
    firsts: dict[tuple[object, ...], list[int]] = {}
    for place, (run, row) in enumerate(zip(runs, rows, strict=True)):
        group = firsts.setdefault((run.timestep, run.accuracy, run.time.tobytes()), [])
        leader = next((k for k in group if _together(rows[k], row)), place)
        if leader == place:
            group.append(place)
        found.append(leader)
    return found


def sweep_leaders(errors: Sequence[Mapping[float, float | None]], decades: float) -> list[int]:
    """By integrator: the place of the first one whose errors over the step coincide with its own.

    errors: by step, None where there is none.
    """
    height = max(1.0, decades) * _BROAD / _HIGH
    rows = [{h: math.log10(max(e, FLOOR)) for h, e in own.items() if e} for own in errors]

    def one(first: Mapping[float, float], other: Mapping[float, float]) -> bool:
        same = first.keys() == other.keys()
        return same and all(abs(first[h] - other[h]) <= height for h in first)

    return [next(k for k in range(n + 1) if one(rows[k], rows[n])) for n in range(len(rows))]


def _together(one: Array, other: Array) -> bool:
    """NaN, where nothing is drawn, is together with NaN alone."""
    return bool(np.all((np.abs(one - other) <= 1.0) | (np.isnan(one) & np.isnan(other))))


def shown_first(chart: Chart, failing: Collection[Lane] = ()) -> set[Lane]:
    """Of each engine the integrators with the smallest and the largest attitude error, each at its
    finest step, and among those that fail the one with the largest.

    The reference is left out where anything else ran.
    """
    finest: dict[Lane, Series] = {}
    for run in chart.deviations:
        lane = lane_of(run)
        if lane not in finest or _knob(run) < _knob(finest[lane]):
            finest[lane] = run
    judged = [lane for lane in finest if lane[0] not in YARDSTICKS] or list(finest)
    error = {lane: magnitude(finest[lane].largest["attitude"]) for lane in judged}
    found = set()
    for engine in dict.fromkeys(lane[:2] for lane in judged):
        own = [lane for lane in judged if lane[:2] == engine]
        found |= {min(own, key=error.__getitem__), max(own, key=error.__getitem__)}
        failed = [lane for lane in own if lane in failing]
        found |= {max(failed, key=error.__getitem__)} if failed else set()
    return found


def _knob(run: Series) -> float:
    return (run.timestep if run.timestep is not None else run.accuracy) or 0.0
