"""What a failure costs: the attitude's error of the runs that fail, next to sound runs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import isfinite
from typing import Any

import polars as pl

from omegadot.reports.record.record import Record
from omegadot.reports.record.schema import YARDSTICKS
from omegadot.reports.summary.failed_gate import worst_row
from omegadot.reports.text.numbers import angle, angles, plain

WHO = ("engine", "engine_version", "setup")
RUN = ("integrator", "timestep")
Row = Mapping[str, Any]


def cost_of(record: Record, who: tuple[str, ...], rows: Sequence[Row]) -> str:
    """What the failing rows of an engine mean for its attitude; "" where it is not known.

    On the scenario of the worst measure where a run fails there, else of the worst run. A failing
    run costs something where its error neither passes, as an error of its order does, nor lies
    within what sound integrators of its order have at the same step: the worst of these runs is
    named, each at its finest step.
    """
    metrics = record.metrics
    stepped = [row for row in rows if row["integrator"] is not None]
    if not stepped:
        judged = metrics.filter(pl.col("gate") == "trajectory").filter(
            pl.col(key).eq_missing(value) for key, value in zip(WHO, who, strict=True)
        )
        return "nothing in its trajectories, which pass" if "pass" in judged["verdict"] else ""
    where = worst_row(rows)["scenario"]
    here = [row for row in stepped if row["scenario"] == where] or stepped
    scenario = worst_row(here)["scenario"]
    failing = {tuple(map(row.get, RUN)) for row in here if row["scenario"] == scenario}
    errors = _errors(metrics, scenario)
    of_engine = [row for row in errors if _who(row) == who]
    own = [row for row in of_engine if tuple(map(row.get, RUN)) in failing]
    sound = [row for row in errors if _who(row) != who and row["verdict"] == "pass"]
    if not own:
        return ""
    costly = [row for row in own if _is_costly(record, row, sound)]
    if costly:
        return _costs(record, _worst_at_finest(costly), sound, scenario)
    return _costs_nothing(record, _worst_at_finest(own), sound, scenario)


def _who(row: Row) -> tuple[Any, ...]:
    return tuple(map(row.get, WHO))


def _costs(record: Record, row: Row, sound: Sequence[Row], scenario: str) -> str:
    step = f"step {plain(row['timestep'])} s"
    text = f"attitude wrong by {angle(row['value'])} on {scenario} with {row['integrator']}, {step}"
    at_step = [one for one in sound if one["timestep"] == row["timestep"]]
    if not at_step:
        return text
    order = order_of(record, row)
    same = _of_order(record, at_step, order)
    whose = "sound integrators"
    if same:
        whose += f" of order {plain(order)}"
    elif order is not None:
        whose += " of other orders"
    return f"{text}; {whose}: {angles([one['value'] for one in same or at_step])}"


def _costs_nothing(record: Record, row: Row, sound: Sequence[Row], scenario: str) -> str:
    step = f"step {plain(row['timestep'])} s"
    text = (
        f"nothing in the attitude on {scenario}: {row['integrator']}, {step}, has an error of "
        f"{angle(row['value'])} there"
    )
    order = order_of(record, row)
    at_step = [one for one in sound if one["timestep"] == row["timestep"]]
    if same := _of_order(record, at_step, order):
        values = angles([one["value"] for one in same])
        return f"{text}, as sound integrators of order {plain(order)} have: {values}"
    return f"{text}, which passes as the truncation error of its order"


def _is_costly(record: Record, row: Row, sound: Iterable[Row]) -> bool:
    """Whether a run's error is more than a sound one's. Two that are equal but for rounding differ
    by their round-off bounds at most.
    """
    if row["verdict"] == "pass":  # the truncation error of its order, or rounding
        return False
    at_step = [one for one in sound if one["timestep"] == row["timestep"]]
    same = _of_order(record, at_step, order_of(record, row))
    largest = max((one["value"] + (one["bound"] or 0.0) for one in same), default=-1.0)
    return bool(row["value"] - (row["bound"] or 0.0) > largest)


def _of_order(record: Record, rows: Iterable[Row], order: float | None) -> list[Row]:
    return [row for row in rows if order is not None and order_of(record, row) == order]


def _worst_at_finest(rows: Sequence[Row]) -> Row:
    """The largest error of integrators, each at the finest of these steps."""
    finest = {
        name: min(row["timestep"] for row in rows if row["integrator"] == name)
        for name in {row["integrator"] for row in rows}
    }
    at_finest = [row for row in rows if row["timestep"] == finest[row["integrator"]]]
    return max(at_finest, key=lambda row: row["value"])


def order_of(record: Record, row: Row) -> float | None:
    """The order in attitude that a row's integrator declares; None without any."""
    for engine in record.run["engines"]:
        for integrator in engine.get("integrators") or ():
            if (engine["name"], integrator["name"]) == (row["engine"], row["integrator"]):
                return (integrator.get("orders") or {}).get("attitude")
    return None


def _errors(metrics: pl.DataFrame, scenario: str) -> list[dict[str, Any]]:
    """The attitude's largest errors of every engine on a scenario, by step."""
    of_attitude = (pl.col("channel") == "attitude") & (pl.col("metric") == "error_max")
    judged = metrics.filter((pl.col("gate") == "trajectory") & (pl.col("scenario") == scenario))
    rows = judged.filter(of_attitude & ~pl.col("engine").is_in(YARDSTICKS)).to_dicts()
    return [r for r in rows if r["timestep"] and r["value"] is not None and isfinite(r["value"])]
