"""Errors by version as drawings: one line an integrator, one picture a scenario."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from omegadot.reports.charts.palette import DASHES
from omegadot.reports.text.numbers import plain, short

Record = dict[str, Any]
WIDTH, HEIGHT = 720, 260
LEFT, RIGHT, TOP, BOTTOM = 64, 12, 12, 46
LEAST = 1e-17  # an error of zero is drawn here


@dataclass(frozen=True)
class Series:
    """An integrator's line. points: pieces of an SVG path, a break where it has no figure."""

    name: str
    colour: int
    dash: str
    path: str
    dots: list[tuple[float, float, str]]


@dataclass(frozen=True)
class Chart:
    """One scenario: its lines, the ticks of its axes (place, text)."""

    title: str
    series: list[Series]
    versions: list[tuple[float, str]]
    decades: list[tuple[float, str]]


def charts_of(record: Record) -> list[Chart]:
    """The largest error in attitude by version, on a logarithmic scale."""
    known = [version for version in record["versions"] if version["outcome"] == "ok"]
    names = list(dict.fromkeys(name for version in known for name in version["integrators"]))
    return [chart for case in record["cases"] if (chart := _chart(case, known, names))]


def _error(version: Record, case: Record, name: str) -> float | None:
    metric = f"drift:{case['name']}:{name}:{plain(case['timestep'])}:attitude"
    figure = version["figures"].get(metric) or {}
    value = figure.get("value")
    return max(float(value), LEAST) if isinstance(value, float | int) else None


def _chart(case: Record, known: Sequence[Record], names: Sequence[str]) -> Chart | None:
    errors = {name: [_error(version, case, name) for version in known] for name in names}
    values = [math.log10(e) for line in errors.values() for e in line if e is not None]
    if not values:
        return None
    low, high = math.floor(min(values)), max(math.ceil(max(values)), math.floor(min(values)) + 1)
    across = (WIDTH - LEFT - RIGHT) / max(1, len(known))

    def x(place: int) -> float:
        return LEFT + across * (place + 0.5)

    def y(decade: float) -> float:
        return TOP + (HEIGHT - TOP - BOTTOM) * (high - decade) / (high - low)

    series = []
    for number, name in enumerate(names):
        dots = [
            (x(n), y(math.log10(e)), f"{name}, {known[n]['version']}: {short(e)} rad")
            for n, e in enumerate(errors[name])
            if e is not None
        ]
        dash = DASHES[number % len(DASHES)]
        series.append(Series(name, number, dash, _path(dots, across), dots))
    every = max(1, (high - low) // 6)
    return Chart(
        f"{case['title']}, steps of {plain(case['timestep'])} s: largest error in attitude, rad",
        series,
        [(x(n), version["version"]) for n, version in enumerate(known)],
        [(y(d), f"1e{d}") for d in range(low, high + 1, every)],
    )


def _path(dots: Sequence[tuple[float, float, str]], across: float) -> str:
    """Lines between neighbouring versions; a version without a figure breaks the line."""
    pieces: list[str] = []
    before = -math.inf
    for x, y, _ in dots:
        joined = x - before <= 1.01 * across
        pieces.append(f"{'L' if joined else 'M'}{x:.1f} {y:.1f}")
        before = x
    return " ".join(pieces)
