"""The failing engines, a sentence each: where, by how much, how often, and the likeliest cause."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from math import isfinite
from typing import Any

import polars as pl

from omegadot.reports.record.record import Record
from omegadot.reports.record.schema import YARDSTICKS
from omegadot.reports.summary.failed_gate import measure, worst_row
from omegadot.reports.summary.reasons import cause_of, failing_gates
from omegadot.reports.text.numbers import engine_name, knob, quantity, times

UNKNOWN = "none is known"
WHO = ("engine", "engine_version", "setup")


def failures_of(record: Record) -> tuple[str, ...]:
    """Of every failing engine, the first gate that fails and its worst measure."""
    who = WHO
    rows = record.metrics.filter(pl.col("verdict") == "fail").to_dicts()
    several = Counter(name for name, *_ in {tuple(row[key] for key in who) for row in rows})
    found: dict[tuple[str, ...], list[dict[str, Any]]] = {}
    for row in rows:
        found.setdefault(tuple(row[key] for key in who), []).append(row)
    sentences = []
    for (engine, version, setup), own in found.items():
        name = engine_name(engine, version if several[engine] > 1 else "", setup)
        tasks = [t for t in record.run["tasks"] if t["engine"] == engine]
        worth = _worth(record.metrics, (engine, version, setup), own)
        sentences.append(f"{name}: {_worst(own)}{_extent(tasks)}{worth}{_likeliest(tasks)}.")
    return tuple(sentences)


def _worst(rows: list[dict[str, Any]]) -> str:
    row = worst_row(rows)
    by = f" {row['integrator']}" if row["integrator"] else ""
    return f"the {row['gate']} gate fails on {row['scenario']}{by}, {measure(row)}"


def _extent(tasks: list[Mapping[str, Any]]) -> str:
    failing = list(filter(failing_gates, tasks))
    return f" ({len(failing)} of {times(len(tasks), 'run')} fail)" if failing else ""


def _worth(metrics: pl.DataFrame, who: tuple[str, ...], rows: list[dict[str, Any]]) -> str:
    """What a failure costs: the attitude at the finest step there, next to engines that pass."""
    judged = pl.col("gate") == "trajectory"
    stepped = [row for row in rows if row["integrator"] is not None]
    if not stepped:
        of_engine = pl.all_horizontal(
            pl.col(k).eq_missing(v) for k, v in zip(WHO, who, strict=True)
        )
        passes = metrics.filter(judged & of_engine)["verdict"].to_list()
        return ". Its trajectories pass" if "pass" in passes else ""
    worst = worst_row(stepped)
    where = judged & (pl.col("channel") == "attitude") & (pl.col("metric") == "error_max")
    where &= (pl.col("scenario") == worst["scenario"]) & ~pl.col("engine").is_in(YARDSTICKS)
    known = [row for row in metrics.filter(where).to_dicts() if row["timestep"]]
    finest = min((row["timestep"] for row in known), default=None)
    known = [row for row in known if row["timestep"] == finest and isfinite(row["value"])]
    own = [r["value"] for r in known if tuple(map(r.get, WHO)) == who and _is_of(r, worst)]
    theirs = [r["value"] for r in known if tuple(map(r.get, WHO)) != who and r["verdict"] == "pass"]
    if not own or not theirs:
        return ""
    ends = [quantity(end, "rad") for end in dict.fromkeys((min(theirs), max(theirs)))]
    others = f"that of engines that pass by {' to '.join(ends)}"
    off = f"its attitude errs by {quantity(max(own), 'rad')}"
    return f". On {worst['scenario']} {off}, {others} ({knob(finest, None)})"


def _is_of(row: Mapping[str, Any], worst: Mapping[str, Any]) -> bool:
    return bool(row["integrator"] == worst["integrator"])


def _likeliest(tasks: list[Mapping[str, Any]]) -> str:
    """The cause that explains most runs, with how many others there are."""
    causes = Counter(filter(None, map(cause_of, tasks)))
    known = [(cause, n) for cause, n in causes.most_common() if not cause.startswith(UNKNOWN)]
    if not known:
        return ""
    more = f"; {times(len(known) - 1, 'other cause')} elsewhere" if len(known) > 1 else ""
    return f". Likely cause: {known[0][0].rstrip('.')}{more}"
