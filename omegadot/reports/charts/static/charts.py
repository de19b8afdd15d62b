"""What the pictures of one scenario are drawn from, and the parts that several of them have."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from omegadot.reports.charts.bounds import Limits, limits_of
from omegadot.reports.charts.deviations import Chart, Series, chart_deviations
from omegadot.reports.charts.palette import Line, lines_of
from omegadot.reports.charts.static.legend import Entry, Part
from omegadot.reports.charts.static.style import DOTTED, GREY
from omegadot.reports.charts.sweeps import Sweep, sweeps_of
from omegadot.reports.record.record import Record
from omegadot.reports.text.numbers import short

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Lane = tuple[str, str, str]
# Decades below the smallest error that are drawn for the floor's sake; more would flatten the rest.
_NEAR = 1e-3


@dataclass(frozen=True)
class Charts:
    """One scenario. lines: how each engine's integrator is drawn, by engine, setup, integrator."""

    name: str
    title: str
    chart: Chart
    sweeps: tuple[Sweep, ...]
    limits: Limits
    lines: Mapping[Lane, Line]

    @property
    def finest(self) -> list[Series]:
        """Each integrator's run at its finest step, in the order of the lines."""
        best: dict[Lane, Series] = {}
        for deviation in self.chart.deviations:
            lane = (deviation.engine, deviation.setup, deviation.integrator)
            if lane not in best or _knob(deviation) < _knob(best[lane]):
                best[lane] = deviation
        return [best[lane] for lane in self.lines if lane in best]


def _knob(deviation: Series) -> float:
    step = deviation.timestep if deviation.timestep is not None else deviation.accuracy
    return step if step is not None else 0.0


def charts_of(record: Record) -> list[Charts]:
    """Every scenario of which trajectories are stored, in the record's order."""
    charts = {name: chart for name, chart in chart_deviations(record).items() if chart.units}
    lines = {
        (line.engine, line.setup, line.integrator): line
        for line in lines_of(charts.values(), record.run["engines"])
    }
    sweeps, limits = sweeps_of(record.metrics), limits_of(record.metrics)
    titles = {e["name"]: e.get("title") or e["name"] for e in record.run["scenarios"]}
    return [
        Charts(
            name,
            titles.get(name, name),
            charts[name],
            tuple(s for s in sweeps.get(name, []) if (s.engine, s.setup, s.integrator) in lines),
            limits.get(name, Limits()),
            lines,
        )
        for name in charts
    ]


def bound_part(xs: Sequence[float], ys: Sequence[float]) -> list[Part]:
    """How far rounding may take the error, where that is known."""
    if not xs:
        return []
    return [(Entry(None, "round-off bound"), partial(_dotted, xs=xs, ys=ys))]


def _dotted(axes: Axes, xs: Sequence[float], ys: Sequence[float]) -> Any:
    return axes.plot(xs, ys, color=GREY, linestyle=DOTTED, linewidth=0.8)[0]


def floor_part(floor: float | None, smallest: float) -> list[Part]:
    """The floor, where there is one. smallest: the smallest error drawn."""
    if not floor:
        return []
    if floor >= _NEAR * smallest:
        return [(Entry(None, "floor"), partial(_level, floor=floor))]
    return [(Entry(None, "floor", f" {short(floor)}, below"), _level_below)]


def _level(axes: Axes, floor: float) -> Any:
    return axes.axhline(floor, color=GREY, linewidth=0.6, zorder=1)


def _level_below(axes: Axes) -> Any:
    """A handle for the legend alone."""
    return axes.plot([], [], color=GREY, linewidth=0.6)[0]
