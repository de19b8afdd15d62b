"""Each engine in one row: can it be trusted, how wrong is it, why, and what does it cost."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from statistics import median

import polars as pl

from omegadot.reports.summary.figures import Figure, Range, size
from omegadot.reports.summary.matrix import MARKS
from omegadot.reports.summary.provenance import Sources
from omegadot.reports.summary.summary import STATUSES, YARDSTICKS, Cell, Column, Summary
from omegadot.reports.text.numbers import knob, short, times

# A cell is what is said, and in smaller letters what it is of.
Judgement = tuple[str, str]


@dataclass(frozen=True)
class Glance:
    """One engine over all scenarios. best and worst: of its integrators, at their finest step."""

    engine: str
    status: str
    mark: str
    runs: str
    residual: Judgement
    best: Judgement
    worst: Judgement
    why: Judgement
    cost: Judgement
    source: int


def glances(summary: Summary, metrics: pl.DataFrame, sources: Sources) -> list[Glance]:
    """One row an engine; the yardsticks stand aside where anything else ran."""
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
    version = "" if column.version in column.label else f" {column.version}"
    origin = {"engine": column.engine, "engine_version": column.version, "setup": column.setup}
    return Glance(
        column.label + version,
        status.replace("-", " "),
        MARKS.get(status, "–"),
        _runs(cells),
        _residual(cells),
        _spread(ranges, lambda found: found.best),
        _spread(ranges, lambda found: found.worst),
        _why(own),
        _cost(own),
        sources.number(origin),
    )


def _runs(cells: Iterable[Cell]) -> str:
    runs = sum((cell.runs for cell in cells), Counter[str]())
    return f"{runs.get('pass', 0)} of {times(sum(runs.values()), 'run')} pass"


def _residual(cells: Iterable[Cell]) -> Judgement:
    worst = max((cell.residual for cell in cells if cell.residual), key=size, default=None)
    if worst is None:
        return "–", ""
    bound = "" if worst.bound is None else f"; bound {short(worst.bound)}"
    return short(worst.value), f"on {worst.scenario}{bound}"


def _spread(ranges: list[Range], end: Callable[[Range], Figure]) -> Judgement:
    """The middle one of all scenarios, and the largest with the run that gave it."""
    figures = [end(found) for found in ranges]
    if not figures:
        return "–", ""
    largest = max(figures, key=size)
    usual = Counter(figure.integrator for figure in figures).most_common(1)[0][0]
    middle = short(median(size(figure) for figure in figures))
    run = ", ".join(filter(None, (largest.integrator, knob(largest.timestep, largest.accuracy))))
    reported = f"mostly {usual}; at most {short(largest.value)}: {run} on {largest.scenario}"
    return f"{middle} rad", reported


def _why(own: pl.DataFrame) -> Judgement:
    """In how many runs the engine's course is that of its declared scheme, to rounding."""
    judged = own.filter((pl.col("metric") == "match") & pl.col("verdict").is_in(["pass", "fail"]))
    if judged.is_empty():
        return "–", "held against no scheme"
    equal = int((judged.get_column("verdict") == "pass").sum())
    if equal == len(judged):
        return "its schemes' errors", f"all {times(equal, 'run')} equal the declared scheme"
    return "not its schemes alone", f"{equal} of {times(len(judged), 'run')} equal the declared one"


def _cost(own: pl.DataFrame) -> Judgement:
    """The middle time per step, from the cheapest integrator to the dearest."""
    steps = own.filter((pl.col("metric") == "time_per_step") & pl.col("value").is_finite())
    if steps.is_empty():
        return "–", ""
    found = steps.group_by("integrator").agg(pl.col("value").median()).sort("value", "integrator")
    (cheap, low), (dear, high) = found.row(0), found.row(-1)
    if cheap == dear:
        return f"{_micro(low)} µs", str(cheap)
    return f"{_micro(low)} … {_micro(high)} µs", f"{cheap} … {dear}"


def _micro(seconds: float) -> str:
    return f"{1e6 * seconds:.3g}"
