"""Each engine in one row: verdict, residual, attitude error, source of error and cost."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from statistics import median
from typing import Any

import polars as pl

from omegadot.reports.record.schema import GATES, YARDSTICKS
from omegadot.reports.summary.figures import Figure, size, worst_residual
from omegadot.reports.summary.matrix import MARKS, origin_of
from omegadot.reports.summary.provenance import Sources
from omegadot.reports.summary.summary import Cell, Column, Summary, text_of, worst
from omegadot.reports.text.metric_names import residual_name
from omegadot.reports.text.numbers import (
    angle,
    grouped,
    knob,
    listed,
    short,
    times,
)

# A cell: the value, its details, which may be folded away, and what stands beside it in any case.
Detailed = tuple[str, str] | tuple[str, str, str]


def glances(summary: Summary, metrics: pl.DataFrame, sources: Sources) -> list[dict[str, Any]]:
    """One row an engine over all scenarios, failing ones first.

    The yardsticks are left out where anything else ran.

    best and worst: of its integrators, at their finest step.  error_source: whether its errors are
    those of the declared schemes.
    """
    engines = [c for c in summary.columns if c.engine not in YARDSTICKS] or list(summary.columns)
    rows = [_glance(column, summary, metrics, sources) for column in engines]
    return sorted(rows, key=lambda row: row["status"] != "fail")


def _glance(
    column: Column, summary: Summary, metrics: pl.DataFrame, sources: Sources
) -> dict[str, Any]:
    cells = [summary.cells[name, column] for name in summary.scenarios]
    own = metrics.filter(engine=column.engine, engine_version=column.version, setup=column.setup)
    status = worst(cell.status for cell in cells)
    ranges = [cell.attitude for cell in cells if cell.attitude]
    return {
        "engine": column.name,
        "status": status.replace("-", " "),
        "mark": MARKS.get(status, "–"),
        "runs": _runs(cells, status),
        "far_off": _far_off(cells) if status == "pass" else "",
        "residual": _residual(cells),
        "best": _largest([found.best for found in ranges]),
        "worst": _largest([found.worst for found in ranges]),
        "error_source": _error_source(own),
        "cost": _cost(own),
        "source": sources.number(origin_of(column)),
    }


def _far_off(cells: Iterable[Cell]) -> str:
    """How far off the worst scenario is that passes; "" where none is."""
    found = [cell for cell in cells if cell.far_off and cell.attitude]
    worst = max(found, key=lambda c: size(c.attitude.worst) if c.attitude else 0.0, default=None)
    return worst.far_off if worst else ""


def _runs(cells: Iterable[Cell], status: str) -> str:
    """How many runs fail where the engine does, else how many pass, and how many do neither."""
    runs = sum((cell.runs for cell in cells), Counter[str]())
    own = status if status in ("fail", "pass") else "pass"
    text = f"{runs[own]} of {times(sum(runs.values()), 'run')} {own}"
    others = [f"{n} {text_of(s)}" for s, n in runs.items() if n and s not in ("pass", "fail", own)]
    return "; ".join([text, *others])


def _residual(cells: Iterable[Cell]) -> Detailed:
    """The largest; where one is above its bound, the one that is so by the most."""
    worst = worst_residual(cell.residual for cell in cells if cell.residual)
    if worst is None:
        return "–", ""
    bound = "" if worst.bound is None else f"; bound {short(worst.bound)}"
    name = residual_name(worst.metric)
    return short(worst.value), f"{name}{', ' * bool(name)}on {worst.scenario}{bound}"


def _largest(figures: list[Figure]) -> Detailed:
    """The largest over the scenarios with where it is, and folded away its step and the median.

    The median alone would hide the one scenario on which an engine is no use, or fails.
    """
    if not figures:
        return "–", ""
    largest = max(figures, key=size)
    step = knob(largest.timestep, largest.accuracy)
    middle = f"median of {len(figures)} scenarios {short(median(map(size, figures)))} rad"
    details = [step, middle if len(figures) > 1 else ""]
    beside = [largest.integrator or "", f"on {largest.scenario}"]
    return angle(largest.value), "; ".join(filter(None, details)), ", ".join(filter(None, beside))


def _error_source(own: pl.DataFrame) -> Detailed:
    """In how many runs the engine's trajectory is that of its declared scheme, to rounding."""
    judged = own.filter((pl.col("metric") == "match") & pl.col("verdict").is_in(["pass", "fail"]))
    failed = set(own.filter(pl.col("verdict") == "fail").get_column("gate"))
    gates = [gate for gate in GATES if gate in failed]
    fails = "gates fail" if len(gates) > 1 else "gate fails"
    source = f"a fault: {listed(gates)} {fails}" if gates else "truncation error of the scheme"
    if judged.is_empty():
        return source if gates else "no scheme declared", "no scheme declared" if gates else ""
    equal, total = int((judged.get_column("verdict") == "pass").sum()), len(judged)
    runs = f"{equal} of {times(total, 'run')}" if equal < total else f"all {total} runs"
    runs = "1 run" if equal == total == 1 else runs
    return source, f"equals the declared scheme in {runs}"


def _cost(own: pl.DataFrame) -> Detailed:
    """The median time per step, from the cheapest integrator to the most expensive."""
    steps = own.filter((pl.col("metric") == "time_per_step") & pl.col("value").is_finite())
    if steps.is_empty():
        return "–", ""
    found = steps.group_by("integrator").agg(pl.col("value").median()).sort("value", "integrator")
    (cheapest, low), (slowest, high) = found.row(0), found.row(-1)
    if cheapest == slowest:
        return f"{grouped(1e6 * low)} µs", str(cheapest)
    return f"{grouped(1e6 * low)} … {grouped(1e6 * high)} µs", f"{cheapest} … {slowest}"
