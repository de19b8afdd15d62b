"""What the page's script gets: the lines' looks, and every error as packed 16-bit logarithms."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
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
    codes = Codes()
    scenarios: dict[str, Any] = {}
    for name, chart in charts.items():
        own = limits.get(name, Limits())
        drawn = [[drawn_values(run, c) for run in chart.deviations] for c in chart.units]
        axes = [_axis_of(chart, c, own, d) for c, d in zip(chart.units, drawn, strict=True)]
        led = [
            leaders(chart.deviations, found, axis["high"] - axis["low"], axis["resolvable"])
            for axis, found in zip(axes, drawn, strict=True)
        ]
        starts = [codes.keep(found, lead) for found, lead in zip(drawn, led, strict=True)]
        rank = rank_of(chart)
        entries = [
            [
                places[lane_of(run)],
                rank[run.timestep, run.accuracy],
                clocks.setdefault(run.time.tobytes(), len(clocks)),
                [own_starts[k] for own_starts in starts],
                len(run.time),
                _bounds_drawn(own, run, chart),
                sources.number(vars(run)),
                [own_led[k] for own_led in led],
            ]
            for k, run in enumerate(chart.deviations)
        ]
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
    return description, np.concatenate(codes.parts)


@dataclass
class Codes:
    """The codes of all charts in a row. parts: those kept so far; used: how many these are."""

    parts: list[Array] = field(default_factory=lambda: [np.empty(0, np.uint16)])
    used: int = 0

    def keep(self, drawn: Sequence[Array], led: Sequence[int]) -> list[int]:
        """Where the codes of each run of a chart start: one that is equal to its leader's to a
        code, a thousandth, has the place of that.
        """
        if not drawn:
            return []
        ends = np.cumsum([len(values) for values in drawn])[:-1]
        coded = np.split(codes_of(np.concatenate(drawn)), ends)
        starts: list[int] = []
        for place, (codes, leader) in enumerate(zip(coded, led, strict=True)):
            difference = codes.astype(int) - coded[leader]
            if leader < place and np.all(np.abs(difference) <= 1):
                starts.append(starts[leader])
                continue
            starts.append(self.used)
            self.parts.append(codes)
            self.used += len(codes)
        return starts


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


def _axis_of(chart: Chart, channel: str, limits: Limits, drawn: Sequence[Array]) -> dict[str, Any]:
    """Decades that hold the errors of every step size, so that a change of step moves no axis.

    They hold the bounds and the floor too: what judges an error must be visible.
    """
    unit = chart.units[channel]
    values = np.concatenate(drawn)
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
