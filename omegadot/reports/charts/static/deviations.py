"""A picture of one channel along the run: every integrator at its finest step."""

from __future__ import annotations

from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from omegadot.reference_impl.system import Array
from omegadot.reports.charts.bounds import Steps
from omegadot.reports.charts.deviations import Series
from omegadot.reports.charts.packing import FLOOR
from omegadot.reports.charts.palette import Line
from omegadot.reports.charts.static.charts import Charts, bound_part, floor_part
from omegadot.reports.charts.static.legend import Entry, Part, picture
from omegadot.reports.charts.static.style import line_style, title
from omegadot.reports.page.tables import unit_text
from omegadot.reports.text.numbers import plain, short

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# The title, and what is drawn.
CHANNELS = {
    "omega_dot": ("Omega-dot error along the run", "|ω̇ − ω̇ exact|"),
    "energy": ("Energy error", "|E − E exact|"),
    "angular_momentum": ("Angular-momentum error", "|H − H exact|"),
    "linear_momentum": ("Linear-momentum error", "|p − p exact|"),
    "attitude": ("Attitude error", "angle to the exact attitude"),
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
    finest = [(deviation, shown(deviation, channel)) for deviation in charts.finest]
    drawn = [(run, values) for run, values in finest if np.isfinite(values).any()]
    if not drawn:
        return None
    unit = charts.chart.units[channel]
    smallest = min(float(np.nanmin(values)) for _, values in drawn)
    duration = max(float(run.time[-1]) for run, _ in drawn)
    parts = [_part(charts, run, channel, values) for run, values in finest]
    bounds = (charts.limits.bound(run, channel, unit) for run, _ in drawn)
    # Of the integrator whose rounding may grow most.
    bound = max((steps for steps in bounds if steps), key=_last_bound, default=[])
    ends = [0.0, *(part * duration for part, _ in bound)]
    # Drawn as a line, which has a handle of a line in the legend.
    xs = [x for pair in pairwise(ends) for x in pair]
    parts += bound_part(xs, [value for _, value in bound for _ in range(2)])
    parts += floor_part(charts.limits.floor(channel, unit), smallest)
    figure, axes = picture(parts, log="y")
    axes.set_xlim(0.0, duration)
    axes.set_xlabel("time, s")
    what, symbol = CHANNELS[channel]
    axes.set_ylabel(f"{symbol}, {unit_text(unit)}")
    title(axes, charts.title, what + _step(charts.finest))
    return figure


def _part(charts: Charts, run: Series, channel: str, values: Array) -> Part:
    line = charts.lines[run.engine, run.setup, run.integrator]
    draw_line = partial(_trajectory, line=line, time=run.time, values=values)
    return Entry(line, line.name, _text(run, channel)), draw_line


def _trajectory(axes: Axes, line: Line, time: Array, values: Array) -> Any:
    return axes.plot(time, values, **line_style(line))[0]


def _last_bound(steps: Steps) -> float:
    return steps[-1][1]


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
