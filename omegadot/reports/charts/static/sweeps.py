"""Pictures of error over step and of error over cost."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from omegadot.reports.charts.bounds import floor_of
from omegadot.reports.charts.front import FrontPoint, named, pareto_front
from omegadot.reports.charts.static.charts import Charts
from omegadot.reports.charts.static.floor import floor_entries, floor_line
from omegadot.reports.charts.static.legend import Entry, add_legend, height_of
from omegadot.reports.charts.static.style import (
    DOTTED,
    GREY,
    LEGEND_ROW,
    SOFT,
    line_style,
    log_axis,
    new_figure,
    plain_text,
    title,
)
from omegadot.reports.charts.sweeps import Sweep, guides, rounding
from omegadot.reports.text.numbers import plain

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MARK: dict[str, Any] = {"marker": "o", "markersize": 2.4, "markeredgewidth": 0.0}
_FRONT_SHOWN = 12
Lane = tuple[Sweep, list[tuple[float, float]]]


def draw_convergence(charts: Charts) -> Figure | None:
    """Largest attitude error over the step, with lines of the declared orders and rounding."""
    lanes = [(s, [(p.timestep, p.error) for p in s.points if p.error]) for s in charts.sweeps]
    lanes = [(sweep, points) for sweep, points in lanes if points]
    if not lanes:
        return None
    floor, bound, slopes = floor_of(charts.limits), rounding(charts.sweeps), guides(charts.sweeps)
    smallest = min(error for _, points in lanes for _, error in points)
    entries = _entries(charts, lanes)
    entries += [Entry(None, "round-off bound")] * bool(bound)
    entries += [*floor_entries(floor, smallest)]
    entries += [Entry(None, "declared orders")] * bool(slopes)
    figure, axes = _log_log(height_of(entries))
    handles = [_lane(axes, charts, *lane) for lane in lanes]
    handles += _bound(axes, bound) + floor_line(axes, floor, smallest)
    handles += _slopes(axes, slopes)[:1]
    _steps(axes, sorted({h for _, points in lanes for h, _ in points}))
    axes.set_xlabel("step, s")
    axes.set_ylabel("largest attitude error, rad")
    title(axes, charts.title, "Convergence")
    add_legend(figure, handles, entries)
    return figure


def draw_work_precision(charts: Charts) -> Figure | None:
    """Largest attitude error over wall time, the Pareto front drawn and its runs named."""
    lanes = [
        (s, [(p.cost, p.error) for p in s.points if p.error and p.cost]) for s in charts.sweeps
    ]
    lanes = [(sweep, points) for sweep, points in lanes if points]
    if not lanes:
        return None
    floor = floor_of(charts.limits)
    front = [p for p in pareto_front(charts.sweeps, floor) if p.error > 0.0 and p.cost > 0.0]
    texts = _named_front(front)
    smallest = min(error for _, points in lanes for _, error in points)
    entries = [*_entries(charts, lanes), *floor_entries(floor, smallest)]
    entries += [Entry(None, "Pareto front")] * bool(front)
    room = LEGEND_ROW * len(texts)
    figure, axes = _log_log(height_of(entries) + room)
    handles = [_lane(axes, charts, *lane) for lane in lanes]
    handles += floor_line(axes, floor, smallest)
    handles += _front(axes, front)
    axes.set_xlabel("wall time per simulated second, s")
    axes.set_ylabel("largest attitude error, rad")
    title(axes, charts.title, "Work and precision")
    add_legend(figure, handles, entries, above=room)
    height = float(figure.get_size_inches()[1])
    for place, message in enumerate(reversed(texts)):
        level = 0.055 + LEGEND_ROW * place
        figure.text(0.02, level / height, plain_text(message), fontsize=5.4, color=GREY)
    return figure


def _entries(charts: Charts, lanes: Sequence[Lane]) -> list[Entry]:
    lines = [charts.lines[s.engine, s.setup, s.integrator] for s, _ in lanes]
    return [Entry(line, line.name) for line in lines]


def _log_log(room: float) -> tuple[Figure, Axes]:
    figure, axes = new_figure(room)
    axes.set_xscale("log")
    axes.set_yscale("log")
    log_axis(axes.xaxis)
    log_axis(axes.yaxis)
    return figure, axes


def _lane(axes: Axes, charts: Charts, sweep: Sweep, points: list[tuple[float, float]]) -> Any:
    style = line_style(charts.lines[sweep.engine, sweep.setup, sweep.integrator])
    xs, ys = zip(*points, strict=True)
    return axes.plot(xs, ys, **style, **_MARK)[0]


def _steps(axes: Axes, steps: list[float]) -> None:
    """The steps themselves on the axis, where they are few."""
    if len(steps) <= 6:
        axes.set_xticks(steps, [plain(step) for step in steps])
        axes.set_xticks([], minor=True)


def _slopes(axes: Axes, slopes: list[list[float]]) -> list[Any]:
    found: list[Any] = []
    for order, h0, e0, h1, e1 in slopes:
        found += axes.plot([h0, h1], [e0, e1], color=SOFT, linewidth=0.9, zorder=1)
        _note(axes, f"slope {order:g}", (h1, e1), (-2, 2))
    return found


def _note(axes: Axes, text: str, at: tuple[float, float], offset: tuple[int, int]) -> None:
    """A short text near a point; offset: in points of type."""
    axes.annotate(
        text,
        at,
        textcoords="offset points",
        xytext=offset,
        ha="right",
        color=GREY,
        fontsize=5.8,
    )


def _bound(axes: Axes, bound: list[list[float]]) -> list[Any]:
    if not bound:
        return []
    steps, errors = zip(*bound, strict=True)
    found: list[Any] = axes.plot(steps, errors, color=GREY, linestyle=DOTTED, linewidth=0.8)
    return found


def _front(axes: Axes, front: list[FrontPoint]) -> list[Any]:
    if not front:
        return []
    costs, errors = [p.cost for p in front], [p.error for p in front]
    found: list[Any] = axes.plot(
        costs, errors, drawstyle="steps-post", color=SOFT, linewidth=3.0, zorder=1
    )
    for number, point in enumerate(front[:_FRONT_SHOWN], 1):
        # Neighbours stand on either side of the line, so that their numbers do not meet.
        _note(axes, str(number), (point.cost, point.error), (-3, -7 if number % 2 else 3))
    return found


def _named_front(front: list[FrontPoint]) -> list[str]:
    """The runs of the front as text, numbered as in the picture."""
    texts = []
    for number, point in enumerate(front[:_FRONT_SHOWN], 1):
        run, figures = named(point)
        texts.append(f"{number}  {run}: {figures}")
    more = len(front) - len(texts)
    return [*texts, f"and {more} more"] if more else texts
