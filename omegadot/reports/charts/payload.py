"""What the page's script gets: the lines' looks, and every error as packed 16-bit logarithms."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from omegadot.reference_impl.system import Array
from omegadot.reports.charts.axes import axis_of, bounds_drawn, captions, drawn
from omegadot.reports.charts.bounds import Limits, floor_of
from omegadot.reports.charts.deviations import Chart
from omegadot.reports.charts.packing import CEILING_DECADE, FLOOR_DECADE, codes_of
from omegadot.reports.charts.palette import colours, dashes
from omegadot.reports.charts.sweeps import Sweep, sweep_payload
from omegadot.reports.summary.provenance import Sources
from omegadot.reports.text.numbers import plain

_ORDINALS = ("finest", "second finest", "third finest")


@dataclass(frozen=True)
class Line:
    """How one engine's integrator is drawn everywhere. colour: (light, dark); width in px."""

    engine: str
    integrator: str
    setup: str
    colour: tuple[str, str]
    dash: str
    width: float

    @property
    def name(self) -> str:
        """Its name in the legend and the hover text."""
        return f"{self.engine} {self.integrator}" + (self.setup != "physics") * f" ({self.setup})"


def lines_of(charts: Iterable[Chart], engines: list[Mapping[str, Any]]) -> list[Line]:
    """Every line on the page, in the order of the engines.

    The engines first in order are drawn broadest, below the others: where lines coincide, each
    stays visible.
    """
    runs = {(c.engine, c.setup, c.integrator): None for chart in charts for c in chart.deviations}
    order = {entry["name"]: place for place, entry in enumerate(engines)}
    names = sorted({engine for engine, _, _ in runs}, key=lambda n: (order.get(n, len(order)), n))
    colour, dash = colours(names), dashes(engines)
    width = {name: min(4.0, 1.4 + 0.7 * k) for k, name in enumerate(reversed(names))}
    return [
        Line(
            engine,
            name,
            setup,
            colour[engine],
            dash.get((engine, name), ""),
            width[engine] * (1.0 if setup == "physics" else 0.5),
        )
        for engine, setup, name in sorted(runs, key=lambda run: names.index(run[0]))
    ]


def rank_of(chart: Chart) -> dict[tuple[float | None, float | None], int]:
    """0 for the finest step of a scenario, 1 for the next; accuracies are ranked on their own."""
    knobs = {(deviation.timestep, deviation.accuracy) for deviation in chart.deviations}
    steps = sorted(knob for knob in knobs if knob[0] is not None)
    others = sorted((knob for knob in knobs if knob[0] is None), key=lambda k: k[1] or 0.0)
    return {knob: rank for group in (steps, others) for rank, knob in enumerate(group)}


def step_choices(charts: Iterable[Chart]) -> list[str]:
    """The step selector's options: by rank, each with the steps it stands for."""
    by_rank: dict[int, set[float]] = {}
    for chart in charts:
        for (timestep, _), rank in rank_of(chart).items():
            by_rank.setdefault(rank, set()).update([] if timestep is None else [timestep])
    choices = []
    for rank, steps in sorted(by_rank.items()):
        name = _ORDINALS[rank] if rank < len(_ORDINALS) else f"{rank + 1}th finest"
        span = "–".join(plain(s) for s in sorted({min(steps), max(steps)})) if steps else ""
        choices.append(f"{name} ({span} s)" if span else name)
    return choices


def payload(
    charts: Mapping[str, Chart],
    sweeps: Mapping[str, list[Sweep]],
    lines: list[Line],
    limits: Mapping[str, Limits] | None = None,
    sources: Sources | None = None,
) -> tuple[dict[str, Any], Array]:
    """The script's description of every chart, by the scenario's place, and all codes in a row.

    A run is ``[line, rank, times, start, count, bounds, source]``: its channels' codes follow
    each other from `start`, `count` of each, in the order of the scenario's charts; bounds, a
    channel each, are ``[fraction, bound, fraction, bound, ...]``.
    """
    known = sources or Sources()
    places = {(line.engine, line.setup, line.integrator): k for k, line in enumerate(lines)}
    times: dict[bytes, int] = {}
    clocks: list[list[float]] = []
    values: list[Array] = []
    used = 0
    scenarios: dict[str, Any] = {}
    for name, chart in charts.items():
        rank, entries = rank_of(chart), []
        own = (limits or {}).get(name, Limits({}, {}))
        for deviation in chart.deviations:
            key = deviation.time.tobytes()
            if key not in times:
                times[key] = len(clocks)
                clocks.append([float(f"{t:.6g}") for t in deviation.time])
            line = places[deviation.engine, deviation.setup, deviation.integrator]
            count = len(deviation.time)
            knobs = rank[deviation.timestep, deviation.accuracy]
            bounds, source = bounds_drawn(own, deviation, chart), known.number(vars(deviation))
            entries.append([line, knobs, times[key], used, count, bounds, source])
            for channel in chart.units:
                values.append(drawn(deviation, channel))
                used += count
        scenarios[name] = {
            "charts": [axis_of(chart, channel, own) for channel in chart.units],
            "deviations": entries,
            "steps": captions(rank),
            "sweeps": sweep_payload(sweeps.get(name, []), places, known, floor_of(own)),
        }
    description = {
        "floor": FLOOR_DECADE,
        "ceiling": CEILING_DECADE,
        "lines": [{**vars(n), "name": n.name} for n in lines],
        "times": clocks,
        "scenarios": scenarios,
    }
    return description, codes_of(np.concatenate([np.empty(0), *values]))
