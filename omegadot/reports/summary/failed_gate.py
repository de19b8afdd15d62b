"""The gate that a failure begins with, and its worst measure: as a number and in words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Any

import polars as pl

from omegadot.reports.record.schema import GATES
from omegadot.reports.summary.plain import PLAIN, RESIDUAL, is_plain
from omegadot.reports.text.numbers import knob, quantity, short, times_its_bound

SHARE = 1e-3  # from which on a residual is given in percent as well
Row = Mapping[str, Any]


@dataclass(frozen=True)
class FailedGate:
    """The first gate that fails of an engine on a scenario; later ones fail for the same reason.

    number: its worst measure in a few characters, by how many times it is above its bound; "" where
    it is not known.  text: the same in words, with the run.
    """

    gate: str
    number: str = ""
    text: str = ""


def failed_gates(metrics: pl.DataFrame) -> dict[tuple[str, ...], FailedGate]:
    """By scenario, engine, version and setup, where a gate fails."""
    found: dict[tuple[str, ...], list[Row]] = {}
    for row in metrics.filter(pl.col("verdict") == "fail").iter_rows(named=True):
        key = (row["scenario"], row["engine"], row["engine_version"], row["setup"])
        found.setdefault(key, []).append(row)
    return {key: _failed_gate(worst_row(rows)) for key, rows in found.items()}


def _failed_gate(row: Row) -> FailedGate:
    run = ", ".join(filter(None, (row["integrator"], knob(row["timestep"], row["accuracy"]))))
    text = f"{row['gate']} gate: {measure(row)}" + (f" ({run})" if run else "")
    return FailedGate(row["gate"], over_bound(row), text)


def worst_row(rows: Sequence[Row]) -> Row:
    """Of rows that fail, the worst of the plain measures of the first gate.

    Where it is a residual, that of omega-dot, if it fails there, as in every table of residuals.
    """
    gate = min((row["gate"] for row in rows), key=GATES.index)
    own = [row for row in rows if row["gate"] == gate]
    plain = [row for row in own if is_plain(row["metric"])] or own
    worst = max(plain, key=excess)
    if worst["metric"] not in PLAIN:
        return worst
    here = [row for row in plain if row["scenario"] == worst["scenario"]]
    return max((row for row in here if row["channel"] == "omega_dot"), key=excess, default=worst)


def excess(row: Row) -> float:
    """How many times its bound it is; 0 for an order, which is too low, so that it comes last."""
    return 0.0 if row["metric"] == "observed_order" else times_its_bound(row["value"], row["bound"])


def over_bound(row: Row) -> str:
    """The same as text: 1.0e13 × bound, 1.0e0 of order 4, or that there is no number."""
    value, bound = row["value"], row["bound"]
    if value is None or not isfinite(value):
        return "no number"
    if row["metric"] == "observed_order" and bound is not None:
        return f"{value:z.2f} of order {bound:.0f}"
    own = excess(row)
    return f"{short(own)} × bound" if isfinite(own) else quantity(value, row["unit"])


def _percent(row: Row) -> str:
    """A residual of the equation in words: it is relative to the equation's terms by size."""
    if row["gate"] != "equation" or row["unit"] != "1" or not (row["value"] or 0.0) >= SHARE:
        return ""
    return f" ({short(100.0 * row['value'])} % of the terms of the equation)"


def measure(row: Row) -> str:
    """A row in words: its channel and metric, its value, and how many times its bound that is."""
    channel = row["channel"].replace("omega_dot", "omega-dot").replace("_", " ")
    # A share of a bound, or no number: the note states what is wrong.
    if row["note"] and (row["bound"] == 1.0 or not isfinite(row["value"] or 0.0)):
        return f"{channel}: {row['note']}"
    metric, after = row["metric"].replace("_", " "), ""
    if row["metric"].startswith(RESIDUAL) and row["gate"] == "equation" and row["note"]:
        metric = metric if row["metric"] in PLAIN else RESIDUAL
        after = f" {row['note']}"
    text = f"{channel} {metric} {quantity(row['value'], row['unit'])}{_percent(row)}{after}"
    times = excess(row)
    if row["bound"] is not None and 1.0 < times < float("inf"):
        text += f", {short(times)} times its bound"
    return text
