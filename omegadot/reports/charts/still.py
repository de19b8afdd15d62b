"""The charts as SVG: on the page before any script runs, without one, and on paper."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from markupsafe import Markup

from omegadot.reference_impl.system import Array
from omegadot.reports.charts.deviations import Chart, Series
from omegadot.reports.charts.packing import FLOOR
from omegadot.reports.charts.payload import drawn_values
from omegadot.reports.charts.svg import (
    BOTTOM,
    HEIGHT,
    LEFT,
    RIGHT,
    TOP,
    WIDTH,
    Scale,
    across,
    decades,
    grid,
    line_path,
    linear,
    path_of,
    spaced,
    text_at,
    upwards,
    whole,
)
from omegadot.reports.text.numbers import listed, plain

_MOST_STEPS = 8
_FLOOR = ("f", "floor")
_BOUND = ("b", "round-off bound")
_FRONT = ("p", "Pareto front")


@dataclass(frozen=True)
class Still:
    """A picture, and the lines in it: each with the numbers of all that it stands for.

    greys: the lines of no engine, by the class of their look, with their names.
    """

    svg: Markup
    lines: list[list[int]]
    greys: tuple[tuple[str, str], ...] = ()


def stills(chart: Chart, drawn: Mapping[str, Any]) -> dict[str | int, Still]:
    """A scenario's charts, by their kind or the place of their channel.

    drawn: what the script gets, see `payload`; the runs are those of the chart, in its order.
    """
    found: dict[str | int, Still] = {"equation": Still(at_states(drawn["equation"]), [])}
    found |= {place: over_time(chart, drawn, place) for place in range(len(chart.units))}
    return found | {kind: over_sweep(drawn, kind) for kind in ("convergence", "cost")}


def _together(lines: Iterable[tuple[int, Any]]) -> dict[Any, list[int]]:
    """The numbers of lines by their leader, in the order of the lines."""
    groups: dict[Any, list[int]] = {}
    for number, leader in sorted(lines):
        groups.setdefault(leader, []).append(number)
    return groups


def over_time(chart: Chart, drawn: Mapping[str, Any], place: int) -> Still:
    """One channel of the runs shown first, at the finest step, with round-off bound and floor."""
    axis, channel = drawn["charts"][place], list(chart.units)[place]
    end = max(float(run.time[-1]) for run in chart.deviations)
    x, y = across(0.0, end, log=False), upwards(axis)
    runs = [run for run in drawn["deviations"] if run[1] == 0 and run[0] in drawn["first"]]
    groups = _together((run[0], run[7][place]) for run in runs)
    parts = [*grid(linear(x), decades(y, 7), "time, s"), *_floor(axis["resolvable"], y)]
    # Of the run whose rounding may grow most: a staircase, each stair up to its part of the run.
    if stairs := max((r[5][place] for r in runs if r[5][place]), key=_last, default=None):
        ends = np.repeat(np.array([0.0, *stairs[::2]]) * end, 2)[1:-1]
        heights = y.at(np.repeat(stairs[1::2], 2))
        parts.append(f'<path class="b" d="{path_of(x.at(ends), heights)}"/>')
    for leader, (number, *_) in groups.items():
        run = chart.deviations[leader]
        path = path_of(x.at(run.time), _heights(run, channel, y))
        parts.append(line_path(number, path))
    bounded = any(run[5][place] for run in drawn["deviations"])
    greys = ((_BOUND, bounded), (_FLOOR, axis["resolvable"]))
    return Still(whole(parts), list(groups.values()), _there(greys))


def _there(greys: Iterable[tuple[tuple[str, str], Any]]) -> tuple[tuple[str, str], ...]:
    """Those of which there is something."""
    return tuple(grey for grey, known in greys if known)


def _last(stairs: list[float]) -> float:
    return stairs[-1]


def _heights(run: Series, channel: str, y: Scale) -> Array:
    values = drawn_values(run, channel)
    return np.where(np.isnan(values), np.nan, y.at(np.maximum(values, FLOOR)))


def _floor(value: float | None, y: Scale) -> list[str]:
    height = float(y.at(value)) if value else 0.0
    return [f'<path class="f" d="M{LEFT} {height:.0f}H{WIDTH - RIGHT}"/>'] if value else []


def over_sweep(drawn: Mapping[str, Any], kind: str) -> Still:
    """Attitude error over the step (kind convergence) or the cost, of the lines shown first."""
    sweeps, at = drawn["sweeps"], 2 if kind == "cost" else 0
    known = {n: [p for p in own if _drawable(p, at)] for n, own, _ in sweeps["lines"]}
    every = sorted({p[at] for points in known.values() for p in points})
    if not every:
        return Still(whole([]), [])
    low, high = math.log10(every[0]), math.log10(every[-1])
    room = 0.08 * (high - low) + 0.04
    x, y = across(low - room, high + room, log=True), upwards(sweeps)
    if kind == "cost":
        ticks, title = decades(x, 6), "wall time per simulated second, s"
        below = _below("p", drawn["front"], x, y)
    else:
        steps = [(float(x.at(h)), plain(h)) for h in every] if len(every) <= _MOST_STEPS else []
        ticks, title = steps or decades(x, 6), "time step, s"
        below = [*_below("b", sweeps["rounding"], x, y), *_guides(sweeps["guides"], x, y)]
    parts = [*grid(ticks, decades(y, 7), title), *_floor(sweeps["resolvable"], y), *below]
    shown = [(n, n if kind == "cost" else leader) for n, _, leader in sweeps["lines"]]
    groups = _together((n, leader) for n, leader in shown if n in drawn["first"] and known[n])
    for number, *_ in groups.values():
        xs, ys = _places(known[number], at, x, y)
        dots = "".join(f"M{a:.0f} {b:.0f}h0" for a, b in zip(xs, ys, strict=True))
        parts += [line_path(number, path_of(xs, ys)), line_path(number, dots, "o")]
    guides = (
        "d",
        f"declared order {listed([plain(guide[0]) for guide in sweeps['guides']] or [''])}",
    )
    of_step = ((guides, sweeps["guides"]), (_BOUND, sweeps["rounding"]))
    own = ((_FRONT, drawn["front"]),) if kind == "cost" else of_step
    return Still(
        whole(parts), list(groups.values()), _there((*own, (_FLOOR, sweeps["resolvable"])))
    )


def _guides(guides: Iterable[Sequence[float]], x: Scale, y: Scale) -> list[str]:
    """A line of each declared order, from its first step to its last."""
    ends = ((np.array(guide[1::2]), np.array(guide[2::2])) for guide in guides)
    return [f'<path class="d" d="{path_of(x.at(steps), y.at(errors))}"/>' for steps, errors in ends]


def _drawable(point: Sequence[Any], at: int) -> bool:
    return point[1] is not None and _positive(point[at])


def _positive(value: float | None) -> bool:
    return value is not None and 0.0 < value < math.inf


def _places(points: Iterable[Any], at: int, x: Scale, y: Scale) -> tuple[Array, Array]:
    table = np.array([(p[at], max(p[1], FLOOR)) for p in points])
    return x.at(table[:, 0]), y.at(table[:, 1])


def _below(name: str, points: Sequence[Any], x: Scale, y: Scale) -> list[str]:
    """What is drawn below the lines: the round-off bound, or the Pareto front as stairs."""
    if not points:
        return []
    xs, ys = _places(points, 0, x, y)
    if name == "p":
        xs, ys = np.repeat(xs, 2)[1:], np.repeat(ys, 2)[:-1]
    return [f'<path class="{name}" d="{path_of(xs, ys)}"/>']


def at_states(rows: Sequence[Sequence[Any]]) -> Markup:
    """Omega-dot residuals at identical states, a row an engine, with the bound."""
    sizes = [math.log10(value) for row in rows for value in row[4:] if _positive(value)]
    low, high = math.floor(min([*sizes, -16.0])), math.ceil(max([*sizes, -13.0]))
    left, apart = 90, 16 if len(rows) > _MOST_STEPS else 24
    floor = max(HEIGHT - BOTTOM, TOP + apart * len(rows))
    # Zeros stand apart, left of the decades.
    zero, x = left + 10, Scale(low, high, left + 24, WIDTH - RIGHT)
    parts = [text_at((left + WIDTH) / 2, floor + 30, "residual, relative")]
    zeros = [(zero, "0")] if any(0 in row[4:] for row in rows) else []
    ticks = [*zeros, *decades(x, 6)]
    parts += [f'<path class="g" d="M{place:.0f} {TOP}V{floor}"/>' for place, _ in ticks]
    parts += [text_at(place, floor + 14, label) for place, label in spaced(ticks)]
    for number, (_, label, colour, _, *figures) in enumerate(rows):
        y = TOP + (floor - TOP) * (number + 0.5) / len(rows)
        parts.append(text_at(left - 6, y + 4, label if len(label) < 15 else label[:14] + "…", "e"))
        parts.append(f'<g class="k" style="--light:{colour[0]};--dark:{colour[1]}">')
        parts += [
            text_at(float(x.at(value)) if _positive(value) else zero, y + 4, sign)
            for value, sign in ((figures[2], "◇"), (figures[0], "●"))
            if value is not None
        ]
        parts.append("</g>")
        if _positive(figures[1]):
            parts.append(f'<path class="m" d="M{float(x.at(figures[1])):.0f} {y - 7:.0f}v14"/>')
    return whole(parts, floor + BOTTOM)
