"""Work against precision as one drawing: every run that was tried, by engine and integrator."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from omegadot.reports.charts.palette import colours, dashes
from omegadot.reports.charts.plot import Frame, LogAxis, Plot, PlotLine

_FRAME = Frame(width=720, height=340, left=62, right=12, top=12, bottom=44)


@dataclass(frozen=True)
class Drawing(Plot):
    """limit: the height of an error equal to its limit."""

    limit: float


def _axis(values: list[float], start: float, end: float) -> LogAxis:
    low, high = math.log10(min(values)), math.log10(max(values))
    return LogAxis(math.floor(low - 0.05), math.ceil(high + 0.05), start, end)


def _ticks(axis: LogAxis) -> list[tuple[float, str]]:
    return axis.ticks(math.ceil((axis.high - axis.low) / 8))


def _runs(row: Mapping[str, Any], duration: float) -> list[tuple[float, float, float]]:
    """(seconds a simulated second, error over limit, step) of the runs that can be drawn."""
    per_step = row["time_per_step"]
    seconds = per_step["median"] if per_step else None
    found = []
    for trial in row["tried"]:
        ratio, one = trial["ratio"], seconds or trial["seconds_per_step"]
        if ratio and one and math.isfinite(ratio):
            found.append((one * trial["steps"] / duration, ratio, trial["timestep"]))
    return sorted(found)


def drawing(case: Mapping[str, Any], engines: list[dict[str, Any]]) -> Drawing | None:
    """The drawing of a case; None where nothing can be drawn."""
    runs = {
        (row["engine"], row["integrator"]): found
        for row in case["candidates"]
        if (found := _runs(row, case["duration"]))
    }
    if not runs:
        return None
    every = [run for found in runs.values() for run in found]
    x = _axis([cost for cost, _, _ in every], _FRAME.left, _FRAME.width - _FRAME.right)
    floor = _FRAME.height - _FRAME.bottom
    y = _axis([ratio for _, ratio, _ in every] + [1.0], floor, _FRAME.top)
    ink, dash = colours(e["name"] for e in engines), dashes(engines)
    lines = []
    for (engine, integrator), found in runs.items():
        name = f"{engine} {integrator}"
        marks = [
            (x.at(cost), y.at(ratio), f"{name}, step {step:.4g} s: {ratio:.3g}")
            for cost, ratio, step in found
        ]
        path = "M" + " L".join(f"{a} {b}" for a, b, _ in marks)
        lines.append(PlotLine(name, ink[engine], dash.get((engine, integrator), ""), path, marks))
    title = f"{case['name']}: error over limit against cost, every run tried"
    return Drawing(title, _FRAME, lines, _ticks(x), _ticks(y), y.at(1.0))
