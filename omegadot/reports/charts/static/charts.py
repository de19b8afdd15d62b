"""What the pictures of one scenario are drawn from, read once from the record."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from omegadot.reports.charts.bounds import Limits, limits_of
from omegadot.reports.charts.deviations import Chart, Series, chart_deviations
from omegadot.reports.charts.palette import Line, lines_of
from omegadot.reports.charts.sweeps import Sweep, sweeps_of
from omegadot.reports.record.record import Record

Lane = tuple[str, str, str]


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
            limits.get(name, Limits({}, {})),
            lines,
        )
        for name in charts
    ]
