"""The floor in a picture: a line where it is near, a label where it is far below."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from omegadot.reports.charts.static.legend import Entry
from omegadot.reports.charts.static.style import GREY
from omegadot.reports.text.numbers import short

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Decades below the smallest error that are drawn for the floor's sake; more would flatten the rest.
_NEAR = 1e-3


def _is_near(floor: float, smallest: float) -> bool:
    return floor >= _NEAR * smallest


def floor_entries(floor: float | None, smallest: float) -> list[Entry]:
    """The floor's place in the legend, where there is one. smallest: the smallest error drawn."""
    if not floor:
        return []
    if _is_near(floor, smallest):
        return [Entry(None, "floor")]
    return [Entry(None, "floor", f" {short(floor)}, below")]


def floor_line(axes: Axes, floor: float | None, smallest: float) -> list[Any]:
    """The floor drawn, or its handle for the legend alone."""
    if not floor:
        return []
    if _is_near(floor, smallest):
        return [axes.axhline(floor, color=GREY, linewidth=0.6, zorder=1)]
    found: list[Any] = axes.plot([], [], color=GREY, linewidth=0.6)
    return found
