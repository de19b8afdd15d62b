"""Axes, grids and lines as SVG, in few characters: a page holds many of them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from markupsafe import Markup, escape

from omegadot.reference_impl.system import Array
from omegadot.reports.charts.packing import FLOOR_DECADE
from omegadot.reports.text.numbers import plain

# To the right there is room for half of the last label.
WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 440, 240, 46, 16, 8, 34
_RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")
# How wide a letter of a label is on paper, where it is 15 px high.
_LETTER = 8.5
# Half a px: a point that is no farther from the line between its neighbours is left out.
_FLAT = 0.5


@dataclass(frozen=True)
class Scale:
    """Values to px. log: by decades."""

    low: float
    high: float
    start: float
    end: float
    log: bool = True

    def at(self, values: Any) -> Array:
        """Where values are drawn; those beyond the ends stand at the ends."""
        with np.errstate(divide="ignore", invalid="ignore"):
            found = np.log10(values) if self.log else np.asarray(values, dtype=float)
        share = (found - self.low) / ((self.high - self.low) or 1.0)
        return np.asarray(self.start + np.clip(share, 0.0, 1.0) * (self.end - self.start))


def across(low: float, high: float, *, log: bool) -> Scale:
    """The axis from left to right."""
    return Scale(low, high, LEFT, WIDTH - RIGHT, log)


def upwards(axis: Mapping[str, Any]) -> Scale:
    """The script's axis: below the lowest line there is room for its label."""
    high = axis["high"] + 0.1
    low = FLOOR_DECADE - 0.1 * (high - FLOOR_DECADE) if axis["floor"] else axis["low"] - 0.1
    return Scale(low, high, HEIGHT - BOTTOM, TOP)


def path_of(xs: Array, ys: Array) -> str:
    """A line as SVG, in whole px and as few points as it needs; where NaN stands it is broken."""
    known = np.isfinite(xs) & np.isfinite(ys)
    parts = []
    for run in np.split(np.arange(len(xs)), np.flatnonzero(np.diff(known)) + 1):
        if len(run) and known[run[0]]:
            points = _few(np.column_stack((xs[run], ys[run])))
            moves = np.diff(np.rint(points).astype(int), axis=0)
            steps = "".join(f"{dx}{dy:+d}" if dx < 0 else f" {dx}{dy:+d}" for dx, dy in moves)
            parts.append(
                f"M{points[0][0]:.0f} {points[0][1]:.0f}" + (f"l{steps}" if steps else "h0")
            )
    return "".join(parts)


def _few(points: Array) -> Array:
    """Ramer, Douglas and Peucker: the points without which the line would move by _FLAT."""
    kept, open_spans = {0, len(points) - 1}, [(0, len(points) - 1)]
    while open_spans:
        start, end = open_spans.pop()
        if end - start < 2:
            continue
        along, inner = points[end] - points[start], points[start + 1 : end] - points[start]
        away = np.abs(along[0] * inner[:, 1] - along[1] * inner[:, 0]) / (np.hypot(*along) or 1.0)
        place = int(np.argmax(away)) + start + 1
        if away[place - start - 1] > _FLAT:
            kept.add(place)
            open_spans += [(start, place), (place, end)]
    return points[sorted(kept)]


def text_at(x: float, y: float, text: str, kind: str = "") -> str:
    """kind: "e" for a text that ends there; others are centred."""
    own = f' class="{kind}"' if kind else ""
    return f'<text{own} x="{x:.0f}" y="{y:.0f}">{escape(text)}</text>'


def decades(scale: Scale, most: int) -> list[tuple[float, str]]:
    """Places and labels of as many decades as there is room for."""
    low, high = math.ceil(scale.low), math.floor(scale.high)
    every = max(1, math.ceil((high - low) / most))
    found = [n for n in range(low, high + 1) if n % every == 0]
    return [(float(scale.at(10.0**n)), "10" + str(n).translate(_RAISED)) for n in found]


def linear(scale: Scale) -> list[tuple[float, str]]:
    """Places and labels of about four round values, from zero on."""
    if not 0.0 < scale.high - scale.low < math.inf:
        return []
    step = 10.0 ** math.floor(math.log10((scale.high - scale.low) / 4.0))
    step *= max(k for k in (1, 2, 5) if k * step <= (scale.high - scale.low) / 4.0)
    count = math.floor(scale.high / step + 1e-9)
    return [(float(scale.at(k * step)), plain(k * step)) for k in range(count + 1)]


def grid(
    xs: Sequence[tuple[float, str]], ys: Sequence[tuple[float, str]], title: str
) -> Iterable[str]:
    """Rules and labels of both axes, and the title of the one from left to right."""
    bottom = HEIGHT - BOTTOM
    rules = "".join(f"M{LEFT} {y:.0f}H{WIDTH - RIGHT}" for y, _ in ys)
    rules += "".join(f"M{x:.0f} {TOP}V{bottom}" for x, _ in xs)
    yield f'<path class="g" d="{rules}"/>'
    yield from (text_at(LEFT - 5, y + 4, label, "e") for y, label in ys)
    yield from (text_at(x, bottom + 14, label) for x, label in spaced(xs))
    yield text_at((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 4, title)


def spaced(ticks: Sequence[tuple[float, str]]) -> list[tuple[float, str]]:
    """Of labels from left to right those that no label before them touches, on paper neither."""
    found: list[tuple[float, str]] = []
    free = -math.inf
    for place, label in ticks:
        half = 0.5 * _LETTER * len(label)
        if place - half >= free:
            found.append((place, label))
            free = place + half + _LETTER
    return found


def whole(parts: Iterable[str], height: float = HEIGHT) -> Markup:
    """The picture; what it shows is named by what it stands in."""
    body = "".join(parts)
    return Markup(
        f'<svg class="still" viewBox="0 0 {WIDTH} {height:.0f}" aria-hidden="true">{body}</svg>'
    )


def line_path(number: int, path: str, kind: str = "l") -> str:
    """A line by its number on the page; kind: "l" for a line, "o" for dots."""
    return f'<path class="{kind} n{number}" d="{path}"/>'
