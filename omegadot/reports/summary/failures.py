"""The failing engines: which gate, where, by how much, the likeliest cause, and what it costs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Any

import polars as pl

from omegadot.reports.record.record import Record
from omegadot.reports.record.schema import YARDSTICKS
from omegadot.reports.summary.failed_gate import measure, worst_row
from omegadot.reports.summary.reasons import cause_of, failing_gates
from omegadot.reports.text.numbers import engine_name, knob, quantity, short, times

UNKNOWN = "none is known"
# What each gate looks at, for readers who do not know their names.
LOOKS_AT = {
    "model": "the body that it holds",
    "equation": "omega-dot at given states",
    "scheme": "how it steps",
    "invariants": "what must stay constant",
    "trajectory": "the motion over time",
    "cost": "what a step costs",
}
WHO = ("engine", "engine_version", "setup")
Row = Mapping[str, Any]


@dataclass(frozen=True)
class EngineFailure:
    """An engine that fails: the first gate that does, and its worst measure there.

    run: the integrator that gave it, "" where all share it.  extent: how many of its runs fail.
    cause: the likeliest, "" where none is known.  cost: what the failure means for the attitude,
    next to engines that pass; "" where it is not known.
    """

    engine: str
    gate: str
    scenario: str
    run: str
    measured: str
    extent: str
    cause: str
    cost: str

    @property
    def looks_at(self) -> str:
        """What the gate looks at."""
        return LOOKS_AT[self.gate]

    @property
    def sentence(self) -> str:
        """All of it in a few sentences."""
        by = f", {self.run}" if self.run else ""
        head = f"{self.engine} fails the {self.gate} gate ({self.looks_at}) in {self.extent}"
        parts = [f"{head}, worst on {self.scenario}{by}: {self.measured}"]
        parts += [f"Likely cause: {self.cause}"] if self.cause else []
        parts += [f"Cost: {self.cost}"] if self.cost else []
        return ". ".join(parts) + "."


def failures_of(record: Record) -> tuple[EngineFailure, ...]:
    """Every failing engine, in the order of the record."""
    rows = record.metrics.filter(pl.col("verdict") == "fail").to_dicts()
    several = Counter(name for name, *_ in {tuple(row[key] for key in WHO) for row in rows})
    found: dict[tuple[str, ...], list[Row]] = {}
    for row in rows:
        found.setdefault(tuple(row[key] for key in WHO), []).append(row)
    failures = []
    for (engine, version, setup), own in found.items():
        tasks = [task for task in record.run["tasks"] if task["engine"] == engine]
        failing, worst = list(filter(failing_gates, tasks)), worst_row(own)
        failures.append(
            EngineFailure(
                engine_name(engine, version if several[engine] > 1 else "", setup),
                worst["gate"],
                worst["scenario"],
                worst["integrator"] or "",
                measure(worst),
                f"{len(failing)} of {times(len(tasks), 'run')}",
                _likeliest(failing),
                _cost(record.metrics, (engine, version, setup), own),
            )
        )
    return tuple(failures)


def _cost(metrics: pl.DataFrame, who: tuple[str, ...], rows: Sequence[Row]) -> str:
    """The attitude's error at the finest step, next to that of engines that pass.

    On the scenario of the worst measure where a run fails there, else of the worst run.
    """
    stepped = [row for row in rows if row["integrator"] is not None]
    if not stepped:
        judged = metrics.filter(pl.col("gate") == "trajectory").filter(
            pl.col(key).eq_missing(value) for key, value in zip(WHO, who, strict=True)
        )
        return "none in its trajectories, which pass" if "pass" in judged["verdict"] else ""
    where = worst_row(rows)["scenario"]
    here = [row for row in stepped if row["scenario"] == where] or stepped
    scenario = worst_row(here)["scenario"]
    failing = {row["integrator"] for row in here if row["scenario"] == scenario}
    errors = _finest_errors(metrics, scenario)
    own = [r for r in errors if tuple(map(r.get, WHO)) == who and r["integrator"] in failing]
    if not own:
        return ""
    worst = max(own, key=lambda row: row["value"])
    at = f"on {scenario} ({worst['integrator']}, {knob(worst['timestep'], None)})"
    others = [
        r["value"] for r in errors if tuple(map(r.get, WHO)) != who and r["verdict"] == "pass"
    ]
    text = f"its attitude is off by {quantity(worst['value'], 'rad')} {at}"
    ends = [short(end) for end in dict.fromkeys((min(others), max(others)))] if others else []
    return f"{text}; that of engines that pass by {' to '.join(ends)} rad" if ends else text


def _finest_errors(metrics: pl.DataFrame, scenario: str) -> list[dict[str, Any]]:
    """The attitude's largest errors of every engine on a scenario, at the finest step there."""
    of_attitude = (pl.col("channel") == "attitude") & (pl.col("metric") == "error_max")
    judged = metrics.filter((pl.col("gate") == "trajectory") & (pl.col("scenario") == scenario))
    rows = judged.filter(of_attitude & ~pl.col("engine").is_in(YARDSTICKS)).to_dicts()
    known = [r for r in rows if r["timestep"] and r["value"] is not None and isfinite(r["value"])]
    finest = min((row["timestep"] for row in known), default=None)
    return [row for row in known if row["timestep"] == finest]


def _likeliest(failing: Sequence[Row]) -> str:
    """The cause that explains most runs, with how many others there are."""
    causes = Counter(filter(None, map(cause_of, failing)))
    known = [(cause, n) for cause, n in causes.most_common() if not cause.startswith(UNKNOWN)]
    if not known:
        return ""
    more = f"; {times(len(known) - 1, 'other cause')} elsewhere" if len(known) > 1 else ""
    return f"{known[0][0].rstrip('.')}{more}"
