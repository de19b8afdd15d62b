"""A picture and its legend below: engine by engine, each with its integrators in two columns."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from omegadot.reports.charts.palette import Line
from omegadot.reports.charts.static.style import LEGEND_ROW, log_axis, new_figure, plain_text

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LONGEST = 44
_LEFT = 0.02
# Letters that the two columns have room for together.
_ROOM = 58
# in: in addition to the rows, between two blocks.
_GAP = 0.035


@dataclass(frozen=True)
class Entry:
    """One line of a picture. line: None for what belongs to no engine.  message: after its name."""

    line: Line | None
    name: str
    message: str = ""


# What is drawn, and what draws it and returns its handle for the legend.
Part = tuple[Entry, Callable[["Axes"], Any]]


@dataclass(frozen=True)
class Block:
    """Entries below one heading; heading "" where each bears its whole name."""

    heading: str
    colour: str
    names: tuple[str, ...]
    places: tuple[int, ...]

    @property
    def columns(self) -> int:
        """Two where there is room for two side by side; the first is filled first."""
        half = math.ceil(len(self.names) / 2)
        widths = [max(map(len, part), default=0) for part in (self.names[:half], self.names[half:])]
        return 2 if sum(widths) <= _ROOM else 1

    @property
    def height(self) -> float:
        """in, with the gap above it."""
        rows = bool(self.heading) + math.ceil(len(self.names) / self.columns)
        return LEGEND_ROW * rows + _GAP


def blocks_of(entries: Sequence[Entry]) -> list[Block]:
    """A block an engine of several integrators; the others share one, with their whole names."""
    groups: dict[str, list[int]] = {}
    for place, entry in enumerate(entries):
        groups.setdefault(entry.line.engine if entry.line else "", []).append(place)
    alone = [p for engine, own in groups.items() if len(own) == 1 or not engine for p in own]
    found = []
    for engine, own in groups.items():
        line = entries[own[0]].line
        if line is not None and len(own) > 1:
            names = tuple(_short(_integrator(entries[p])) for p in own)
            found.append(Block(_short(engine), line.colour[0], names, tuple(own)))
    if alone:
        names = tuple(_short(entries[p].name, entries[p].message) for p in alone)
        found.append(Block("", "", names, tuple(alone)))
    return found


def _integrator(entry: Entry) -> str:
    line = entry.line
    assert line is not None  # a block's entries are an engine's
    setup = "" if line.setup == "physics" else f" ({line.setup})"
    return line.integrator + setup + entry.message


def _short(name: str, message: str = "") -> str:
    whole = name + message
    return plain_text(whole if len(whole) <= _LONGEST else whole[: _LONGEST - 1] + "…")


def height_of(entries: Sequence[Entry]) -> float:
    """in: how much room the legend takes."""
    return sum(block.height for block in blocks_of(entries))


def picture(parts: Sequence[Part], log: str, room: float = 0.0) -> tuple[Figure, Axes]:
    """The parts with their legend; `log`: the logarithmic axes.

    room: inches that are kept free below the legend.
    """
    entries = [entry for entry, _ in parts]
    figure, axes = new_figure(height_of(entries) + room)
    for name in log:
        axes.set(**{f"{name}scale": "log"})
        log_axis(getattr(axes, f"{name}axis"))
    _add_legend(figure, [draw(axes) for _, draw in parts], entries, room)
    return figure, axes


def _add_legend(
    figure: Figure, handles: Sequence[Artist], entries: Sequence[Entry], above: float
) -> None:
    """Write the legend at the foot of a picture, `above` so many inches that are kept free."""
    whole = float(figure.get_size_inches()[1])
    level = 0.03 + above
    for block in reversed(blocks_of(entries)):
        figure.legend(
            [handles[place] for place in block.places],
            block.names,
            loc="lower left",
            bbox_to_anchor=(_LEFT, level / whole),
            ncols=block.columns,
            borderaxespad=0.0,
            borderpad=0.0,
        )
        level += block.height
        if block.heading:
            at = _LEFT, (level - _GAP - 0.75 * LEGEND_ROW) / whole
            figure.text(*at, block.heading, color=block.colour, fontsize=6.0, fontweight="bold")
