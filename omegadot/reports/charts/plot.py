"""Lines over two axes, for pages without script: a template makes SVG of them."""

from __future__ import annotations

import math
from collections import namedtuple
from dataclasses import dataclass

# px: the whole picture, and what is kept free on each side of the axes.
Frame = namedtuple("Frame", "width height left right top bottom")


@dataclass(frozen=True)
class LogAxis:
    """log10 of the values at the two ends, and where they are drawn, px."""

    low: int
    high: int
    start: float
    end: float

    def at(self, value: float) -> float:
        """Where a value is drawn."""
        share = (math.log10(value) - self.low) / (self.high - self.low)
        return round(self.start + share * (self.end - self.start), 1)

    def ticks(self, every: int) -> list[tuple[float, str]]:
        """Decades, and where they are drawn."""
        return [(self.at(10.0**n), f"1e{n}") for n in range(self.low, self.high + 1, max(1, every))]


@dataclass(frozen=True)
class PlotLine:
    """colour: (light, dark).  path: of SVG.  marks: its points, (x, y) with what each is."""

    label: str
    colour: tuple[str, str]
    dash: str
    path: str
    marks: list[tuple[float, float, str]]


@dataclass(frozen=True)
class Plot:
    """title: what it shows.  x_ticks, y_ticks: places with labels."""

    title: str
    frame: Frame
    lines: list[PlotLine]
    x_ticks: list[tuple[float, str]]
    y_ticks: list[tuple[float, str]]
