"""Pictures of error over step and of error over cost."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from omegadot.reports.charts.bounds import floor_of
from omegadot.reports.charts.front import FrontPoint, named, pareto_front
from omegadot.reports.charts.palette import Line
from omegadot.reports.charts.static.charts import Charts, bound_part, floor_part
from omegadot.reports.charts.static.legend import Entry, Part, picture
from omegadot.reports.charts.static.style import (
    GREY,
    LEGEND_ROW,
    SOFT,
    line_style,
    plain_text,
    title,
)
from omegadot.reports.charts.sweeps import guides, rounding
from omegadot.reports.text.numbers import plain
from omegadot.written import written

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MARK: dict[str, Any] = {"marker": "o", "markersize": 2.4, "markeredgewidth": 0.0}
_FRONT_SHOWN = 12
Lane = tuple[Line, list[tuple[float, float]]]


def draw_convergence(charts: Charts) -> Figure | None:
    """Largest attitude error over the step, with lines of the declared orders and rounding."""
    lanes = _lanes(charts, "timestep")
    if not lanes:
        return None
    bound, slopes = rounding(charts.sweeps), guides(charts.sweeps)
    parts = [*_parts(lanes), *bound_part([h for h, _ in bound], [e for _, e in bound])]
    parts += floor_part(floor_of(charts.limits), _smallest(lanes))
    if slopes:
        parts.append((Entry(None, "declared orders"), partial(_slopes, slopes=slopes)))
    figure, axes = picture(parts, log="xy")
    _steps(axes, sorted({h for _, points in lanes for h, _ in points}))
    axes.set_xlabel("step, s")
    axes.set_ylabel("largest attitude error, rad")
    title(axes, charts.title, "Convergence")
    return figure


def draw_work_precision(charts: Charts) -> Figure | None:
    """Largest attitude error over wall time, the Pareto front drawn and its runs named."""
    lanes = _lanes(charts, "cost")
    if not lanes:
        return None
    floor = floor_of(charts.limits)
    front = [p for p in pareto_front(charts.sweeps, floor) if p.error > 0.0 and p.cost > 0.0]
    texts = _named_front(front)
    parts = [*_parts(lanes), *floor_part(floor, _smallest(lanes))]
    if front:
        parts.append((Entry(None, "Pareto front"), partial(_front, front=front)))
    figure, axes = picture(parts, log="xy", room=LEGEND_ROW * len(texts))
    axes.set_xlabel("wall time per simulated second, s")
    axes.set_ylabel("largest attitude error, rad")
    title(axes, charts.title, "Work and precision")
    height = float(figure.get_size_inches()[1])
    for place, message in enumerate(reversed(texts)):
        level = 0.055 + LEGEND_ROW * place
        figure.text(0.02, level / height, plain_text(message), fontsize=5.4, color=GREY)
    return figure


def _lanes(charts: Charts, over: str) -> list[Lane]:
    """The points of each line that has any, over the step or the cost."""
    found = []
    for sweep in charts.sweeps:
        points = [(x, p.error) for p in sweep.points if (x := getattr(p, over)) and p.error]
        if points:
            found.append((charts.lines[sweep.engine, sweep.setup, sweep.integrator], points))
    return found


def _smallest(lanes: list[Lane]) -> float:
    return min(error for _, points in lanes for _, error in points)


def _parts(lanes: list[Lane]) -> list[Part]:
    return [
        (Entry(line, line.name), partial(_lane, line=line, points=points)) for line, points in lanes
    ]


def _lane(axes: Axes, line: Line, points: list[tuple[float, float]]) -> Any:
    xs, ys = zip(*points, strict=True)
    return axes.plot(xs, ys, **line_style(line), **_MARK)[0]


def _steps(axes: Axes, steps: list[float]) -> None:
    """The steps themselves on the axis, where they are few."""
    if len(steps) <= 6:
        axes.set_xticks(steps, [plain(step) for step in steps])
        axes.set_xticks([], minor=True)


def _slopes(axes: Axes, slopes: list[list[float]]) -> Any:
    """Lines of the orders; the handle of the first, which stands for all."""
    found: list[Any] = []
    for order, h0, e0, h1, e1 in slopes:
        found += axes.plot([h0, h1], [e0, e1], color=SOFT, linewidth=0.9, zorder=1)
        _note(axes, f"slope {written(order)}", (h1, e1), (-2, 2))
    return found[0]


def _note(axes: Axes, text: str, at: tuple[float, float], offset: tuple[int, int]) -> None:
    """A short text near a point; offset: in points of type."""
    axes.annotate(
        text, at, textcoords="offset points", xytext=offset, ha="right", color=GREY, fontsize=5.8
    )


def _front(axes: Axes, front: list[FrontPoint]) -> Any:
    costs, errors = [p.cost for p in front], [p.error for p in front]
    (line,) = axes.plot(costs, errors, drawstyle="steps-post", color=SOFT, linewidth=3.0, zorder=1)
    for number, point in enumerate(front[:_FRONT_SHOWN], 1):
        # Neighbours stand on either side of the line, so that their numbers do not meet.
        _note(axes, str(number), (point.cost, point.error), (-3, -7 if number % 2 else 3))
    return line


def _named_front(front: list[FrontPoint]) -> list[str]:
    """The runs of the front as text, numbered as in the picture."""
    texts = []
    for number, point in enumerate(front[:_FRONT_SHOWN], 1):
        run, figures = named(point)
        texts.append(f"{number}  {run}: {figures}")
    more = len(front) - len(texts)
    return [*texts, f"and {more} more"] if more else texts
