"""A picture of one channel along the run: every integrator at its finest step."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from omegadot.reference_impl.system import Array
from omegadot.reports.charts.deviations import Series
from omegadot.reports.charts.packing import FLOOR
from omegadot.reports.charts.static.charts import Charts
from omegadot.reports.charts.static.floor import floor_entries, floor_line
from omegadot.reports.charts.static.legend import Entry, add_legend, height_of
from omegadot.reports.charts.static.style import (
    DOTTED,
    GREY,
    line_style,
    log_axis,
    new_figure,
    title,
)
from omegadot.reports.page.tables import unit_text
from omegadot.reports.text.numbers import plain, short

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

TITLES = {
    "omega_dot": "Omega-dot divergence along the run",
    "energy": "Energy error",
    "angular_momentum": "Angular-momentum error",
    "linear_momentum": "Linear-momentum error",
    "attitude": "Attitude error",
}
SYMBOLS = {
    "omega_dot": "|ω̇ − ω̇ exact|",
    "energy": "|E − E exact|",
    "angular_momentum": "|H − H exact|",
    "linear_momentum": "|p − p exact|",
    "attitude": "angle to the exact attitude",
}
# A run that blew up may hold anything; this far off nothing more can be read.
_CEILING = 1e6


def shown(deviation: Series, channel: str) -> Array:
    """Values for a logarithmic axis: what is zero, too small to mean anything, or not finite is no
    point of it. So the start, which is given and has no error, is none either.
    """
    values = deviation.values[channel]
    drawable = np.isfinite(values) & (values > FLOOR)
    return np.where(drawable, np.minimum(values, _CEILING), np.nan)


def draw(charts: Charts, channel: str) -> Figure | None:
    """One channel; None where no run has anything to draw there."""
    all_series = [(deviation, shown(deviation, channel)) for deviation in charts.finest]
    drawn = [deviation for deviation, values in all_series if np.isfinite(values).any()]
    if not drawn:
        return None
    unit = charts.chart.units[channel]
    floor = charts.limits.floor(channel, unit)
    bound = _largest_bound(charts, drawn, channel)
    entries = [
        Entry(line := charts.lines[c.engine, c.setup, c.integrator], line.name, _text(c, channel))
        for c, _ in all_series
    ]
    entries += [Entry(None, "round-off bound")] * bool(bound)
    smallest = min(
        float(np.nanmin(values)) for _, values in all_series if np.isfinite(values).any()
    )
    entries += floor_entries(floor, smallest)
    figure, axes = new_figure(height_of(entries))
    axes.set_yscale("log")
    log_axis(axes.yaxis)
    handles = [
        _trajectory(axes, line_style(entry.line), deviation.time, values)
        for (deviation, values), entry in zip(all_series, entries, strict=False)
        if entry.line is not None
    ]
    duration = max(float(deviation.time[-1]) for deviation in drawn)
    handles += _bound(axes, duration, bound) + floor_line(axes, floor, smallest)
    axes.set_xlim(0.0, duration)
    axes.set_xlabel("time, s")
    axes.set_ylabel(f"{SYMBOLS[channel]}, {unit_text(unit)}")
    title(axes, charts.title, TITLES[channel] + _step(charts.finest))
    add_legend(figure, handles, entries)
    return figure


def _trajectory(axes: Axes, style: dict[str, Any], time: Array, values: Array) -> Any:
    return axes.plot(time, values, **style)[0]


def _text(deviation: Series, channel: str) -> str:
    """What cannot be drawn is named: a run that is right to the last digit has no line."""
    if np.isfinite(shown(deviation, channel)).any():
        return ""
    finite = np.isfinite(deviation.values[channel]).any()
    return f" (≤ {short(FLOOR)})" if finite else " (not finite)"


def _step(all_series: list[Series]) -> str:
    steps = {deviation.timestep for deviation in all_series}
    if len(steps) == 1 and None not in steps:
        return f", step {plain(next(iter(steps)))} s"
    return ", each at its finest step"


def _largest_bound(
    charts: Charts, all_series: list[Series], channel: str
) -> list[tuple[float, float]]:
    """(fraction of the run, bound) of the integrator whose rounding may grow most."""
    unit = charts.chart.units[channel]
    found = [charts.limits.bound(deviation, channel, unit) for deviation in all_series]
    return max((steps for steps in found if steps), key=lambda s: s[-1][1], default=[])


def _bound(axes: Axes, duration: float, bound: list[tuple[float, float]]) -> list[Any]:
    """How far rounding may take the error, up to each fraction of the run."""
    if not bound:
        return []
    ends = [0.0, *(part * duration for part, _ in bound)]
    # Drawn as a line, which has a handle of a line in the legend.
    xs = [x for pair in pairwise(ends) for x in pair]
    ys = [value for _, value in bound for _ in range(2)]
    found: list[Any] = axes.plot(xs, ys, color=GREY, linestyle=DOTTED, linewidth=0.8)
    return found
