"""Work against precision as one drawing: every run that was tried, by engine and integrator."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from omegadot.reports.charts.palette import colours, dashes

WIDTH, HEIGHT = 720.0, 340.0
LEFT, RIGHT, TOP, BOTTOM = 62.0, 12.0, 12.0, 44.0


@dataclass(frozen=True)
class Line:
    """One candidate's runs. points: for an SVG polyline; marks: the same, with what they are."""

    label: str
    light: str
    dark: str
    dash: str
    points: str
    marks: list[tuple[float, float, str]]


@dataclass(frozen=True)
class Drawing:
    """x_ticks, y_ticks: places with labels.  limit: the height of an error equal to its limit."""

    lines: list[Line]
    x_ticks: list[tuple[float, str]]
    y_ticks: list[tuple[float, str]]
    limit: float


@dataclass(frozen=True)
class _Axis:
    """log10 of the values at the two ends, and where they are drawn."""

    low: float
    high: float
    start: float
    end: float

    def at(self, value: float) -> float:
        share = (math.log10(value) - self.low) / (self.high - self.low)
        return round(self.start + share * (self.end - self.start), 1)

    def ticks(self) -> list[tuple[float, str]]:
        every = max(1, math.ceil((self.high - self.low) / 8))
        decades = range(math.ceil(self.low), math.floor(self.high) + 1, every)
        return [(self.at(10.0**n), f"1e{n}") for n in decades]


def _axis(values: list[float], start: float, end: float) -> _Axis:
    low, high = math.log10(min(values)), math.log10(max(values))
    return _Axis(math.floor(low - 0.05), math.ceil(high + 0.05), start, end)


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
    x = _axis([cost for cost, _, _ in every], LEFT, WIDTH - RIGHT)
    y = _axis([ratio for _, ratio, _ in every] + [1.0], HEIGHT - BOTTOM, TOP)
    ink, dash = colours(e["name"] for e in engines), dashes(engines)
    lines = []
    for (engine, integrator), found in runs.items():
        marks = [
            (x.at(cost), y.at(ratio), f"{engine} {integrator}, step {step:.4g} s: {ratio:.3g}")
            for cost, ratio, step in found
        ]
        points = " ".join(f"{a},{b}" for a, b, _ in marks)
        light, dark = ink[engine]
        stroke = dash.get((engine, integrator), "")
        lines.append(Line(f"{engine} {integrator}", light, dark, stroke, points, marks))
    return Drawing(lines, x.ticks(), y.ticks(), y.at(1.0))
