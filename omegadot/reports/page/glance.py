"""Each engine in one row: verdict, residual, attitude error, source of error and cost."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from statistics import median

import polars as pl

from omegadot.reports.record.schema import GATES
from omegadot.reports.summary.figures import Figure, Range, size
from omegadot.reports.summary.matrix import MARKS, origin_of
from omegadot.reports.summary.provenance import Sources
from omegadot.reports.summary.summary import STATUSES, YARDSTICKS, Cell, Column, Summary
from omegadot.reports.text.numbers import knob, short, times

# A cell: the value, and in smaller letters its details.
Detailed = tuple[str, str]


@dataclass(frozen=True)
class Glance:
    """One engine over all scenarios. best and worst: of its integrators, at their finest step.

    error_source: whether its errors are those of the declared schemes.
    """

    engine: str
    status: str
    mark: str
    runs: str
    residual: Detailed
    best: Detailed
    worst: Detailed
    error_source: Detailed
    cost: Detailed
    source: int


def glances(summary: Summary, metrics: pl.DataFrame, sources: Sources) -> list[Glance]:
    """One row an engine; the yardsticks are left out where anything else ran."""
    engines = [c for c in summary.columns if c.engine not in YARDSTICKS] or list(summary.columns)
    return [_glance(column, summary, metrics, sources) for column in engines]


def _glance(column: Column, summary: Summary, metrics: pl.DataFrame, sources: Sources) -> Glance:
    cells = [summary.cells[name, column] for name in summary.scenarios]
    own = metrics.filter(
        (pl.col("engine") == column.engine)
        & (pl.col("engine_version") == column.version)
        & (pl.col("setup") == column.setup)
    )
    status = min((cell.status for cell in cells), key=STATUSES.index, default="absent")
    ranges = [cell.attitude for cell in cells if cell.attitude]
    return Glance(
        column.name,
        status.replace("-", " "),
        MARKS.get(status, "–"),
        _runs(cells),
        _residual(cells),
        _spread(ranges, lambda found: found.best),
        _spread(ranges, lambda found: found.worst),
        _error_source(own),
        _cost(own),
        sources.number(origin_of(column)),
    )


def _runs(cells: Iterable[Cell]) -> str:
    runs = sum((cell.runs for cell in cells), Counter[str]())
    return f"{runs.get('pass', 0)} of {times(sum(runs.values()), 'run')} pass"


def _residual(cells: Iterable[Cell]) -> Detailed:
    worst = max((cell.residual for cell in cells if cell.residual), key=size, default=None)
    if worst is None:
        return "–", ""
    bound = "" if worst.bound is None else f"; bound {short(worst.bound)}"
    return short(worst.value), f"on {worst.scenario}{bound}"


def _spread(ranges: list[Range], end: Callable[[Range], Figure]) -> Detailed:
    """The median over the scenarios, and the largest with the run that gave it."""
    figures = [end(found) for found in ranges]
    if not figures:
        return "–", ""
    largest = max(figures, key=size)
    usual = Counter(figure.integrator for figure in figures).most_common(1)[0][0]
    middle = short(median(size(figure) for figure in figures))
    settings = (largest.integrator, knob(largest.timestep, largest.accuracy), largest.scenario)
    run = ", ".join(filter(None, settings))
    details = f"usually {usual}; largest {short(largest.value)} rad ({run})"
    return f"{middle} rad", details


def _error_source(own: pl.DataFrame) -> Detailed:
    """In how many runs the engine's trajectory is that of its declared scheme, to rounding."""
    judged = own.filter((pl.col("metric") == "match") & pl.col("verdict").is_in(["pass", "fail"]))
    if judged.is_empty():
        return "–", "no scheme declared"
    equal, total = int((judged.get_column("verdict") == "pass").sum()), len(judged)
    if equal < total:
        runs = f"{equal} of {times(total, 'run')}"
        return "not the scheme alone", f"equals the declared scheme in {runs}"
    runs = "1 run" if total == 1 else f"all {total} runs"
    failed = set(own.filter(pl.col("verdict") == "fail").get_column("gate"))
    gates = [gate for gate in GATES if gate in failed]
    source = f"failed gate: {', '.join(gates)}" if gates else "truncation error of the scheme"
    return source, f"equals the declared scheme in {runs}"


def _cost(own: pl.DataFrame) -> Detailed:
    """The median time per step, from the cheapest integrator to the most expensive."""
    steps = own.filter((pl.col("metric") == "time_per_step") & pl.col("value").is_finite())
    if steps.is_empty():
        return "–", ""
    found = steps.group_by("integrator").agg(pl.col("value").median()).sort("value", "integrator")
    (cheapest, low), (slowest, high) = found.row(0), found.row(-1)
    if cheapest == slowest:
        return f"{_micro(low)} µs", str(cheapest)
    return f"{_micro(low)} … {_micro(high)} µs", f"{cheapest} … {slowest}"


def _micro(seconds: float) -> str:
    micro = 1e6 * seconds
    return f"{micro:.3g}" if micro < 999.5 else f"{micro:,.0f}"
