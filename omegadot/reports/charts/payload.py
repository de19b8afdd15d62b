"""What the page's script gets: the lines' looks, and every error as packed 16-bit logarithms."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import Any

import numpy as np

from omegadot.reference_impl.system import Array
from omegadot.reports.charts.bounds import Limits, Residual, floor_of
from omegadot.reports.charts.coinciding import Lane, lane_of, leaders, shown_first
from omegadot.reports.charts.deviations import Chart, Series
from omegadot.reports.charts.packing import CEILING_DECADE, FLOOR, FLOOR_DECADE, codes_of, rounded
from omegadot.reports.charts.palette import Line, colours
from omegadot.reports.charts.sweeps import Sweep, decades, sweep_payload
from omegadot.reports.summary.provenance import Sources
from omegadot.reports.text.numbers import engine_name, knob, plain

_ORDINALS = ("finest", "second finest", "third finest")


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
    limits: Mapping[str, Limits],
    sources: Sources,
    failing: Mapping[str, Collection[Lane]] = MappingProxyType({}),
) -> tuple[dict[str, Any], Array]:
    """The script's description of every chart, by the scenario's place, and all codes in a row.

    A run is ``[line, rank, times, starts, count, bounds, source, leaders]``, with a channel each in
    the order of the scenario's charts: where its codes start, `count` of them, which runs share
    that are equal to a code; bounds, ``[fraction, bound, fraction, bound, ...]``; leaders, the
    places of the first run that it coincides with.  first: the lines shown before any is selected.
    failing: by scenario, the lines of which a gate fails.
    """
    places = {(line.engine, line.setup, line.integrator): k for k, line in enumerate(lines)}
    clocks: dict[bytes, int] = {}
    values: list[Array] = []
    stored: dict[int, Array] = {}
    used = 0
    scenarios: dict[str, Any] = {}
    for name, chart in charts.items():
        rank = rank_of(chart)
        entries: list[list[Any]] = []
        own = limits.get(name, Limits())
        axes = [_axis_of(chart, channel, own) for channel in chart.units]
        drawn = [{c: drawn_values(run, c) for c in chart.units} for run in chart.deviations]
        led = [
            leaders(
                chart.deviations,
                [found[axis["channel"]] for found in drawn],
                axis["high"] - axis["low"],
                axis["resolvable"],
            )
            for axis in axes
        ]
        for deviation, found, *leader in zip(chart.deviations, drawn, *led, strict=True):
            clock = clocks.setdefault(deviation.time.tobytes(), len(clocks))
            line = places[lane_of(deviation)]
            count = len(deviation.time)
            knobs = rank[deviation.timestep, deviation.accuracy]
            bounds, source = _bounds_drawn(own, deviation, chart), sources.number(vars(deviation))
            starts = []
            for k, own_values in enumerate(found.values()):
                codes = codes_of(own_values)
                first = entries[leader[k]][3][k] if leader[k] < len(entries) else None
                if first is None or np.any(np.abs(stored[first] - codes.astype(int)) > 1):
                    first, used = used, used + count
                    stored[first] = codes.astype(int)
                    values.append(codes)
                starts.append(first)
            entries.append([line, knobs, clock, starts, count, bounds, source, leader])
        scenarios[name] = {
            "charts": axes,
            "deviations": entries,
            "first": sorted(places[lane] for lane in shown_first(chart, failing.get(name, ()))),
            "steps": _captions(rank),
            "sweeps": sweep_payload(sweeps.get(name, []), places, sources, floor_of(own)),
        }
    description = {
        "floor": FLOOR_DECADE,
        "ceiling": CEILING_DECADE,
        "lines": [{**vars(n), "name": n.name} for n in lines],
        "times": [[rounded(t, 6) for t in np.frombuffer(clock).tolist()] for clock in clocks],
        "scenarios": scenarios,
    }
    return description, np.concatenate([np.empty(0, np.uint16), *values])


def _bounds_drawn(limits: Limits, deviation: Series, chart: Chart) -> list[list[float | None]]:
    """A list a channel: ``[fraction, bound, fraction, bound, ...]``."""
    return [
        [rounded(v, 3) for step in limits.bound(deviation, channel, unit) for v in step]
        for channel, unit in chart.units.items()
    ]


def drawn_values(deviation: Series, channel: str) -> Array:
    """The errors as drawn: without the start, which is given and so has no error."""
    values = deviation.values[channel]
    start = (deviation.time == 0.0) & (values <= FLOOR)
    return np.where(start, np.nan, values)


def _axis_of(chart: Chart, channel: str, limits: Limits) -> dict[str, Any]:
    """Decades that hold the errors of every step size, so that a change of step moves no axis.

    They hold the bounds and the floor too: what judges an error must be visible.
    """
    unit = chart.units[channel]
    values = np.concatenate([drawn_values(deviation, channel) for deviation in chart.deviations])
    floor = limits.floor(channel, unit)
    seen = [bound for c in chart.deviations for _, bound in limits.bound(c, channel, unit)]
    known = np.append(values[~np.isnan(values)], seen + ([] if floor is None else [floor]))
    return {"channel": channel, "unit": unit, "resolvable": rounded(floor, 3), **decades(known)}


def _captions(rank: Mapping[tuple[float | None, float | None], int]) -> list[str]:
    """By rank: the steps and accuracies that it stands for, as text."""
    by_rank: dict[int, list[str]] = {}
    for (timestep, accuracy), place in rank.items():
        by_rank.setdefault(place, []).append(knob(timestep, accuracy))
    return [", ".join(filter(None, by_rank[place])) for place in sorted(by_rank)]


def equation_payload(
    residuals: Iterable[Residual], sources: Sources, engines: Sequence[str]
) -> list[list[Any]]:
    """``[engine, label, colour, source, random, bound, path, bound]`` an engine, in their order.

    engines: all of the page, so that each has the colour that its lines have.
    """
    colour = colours(engines)
    return [
        [
            r.engine,
            engine_name(r.engine, setup=r.setup),
            colour[r.engine],
            sources.number({**vars(r), "engine_version": r.version}),
            *(rounded(value) for value in (*r.random, *r.path)),
        ]
        for r in residuals
        if r.engine != "exact"
    ]
