"""Sources of error: the scheme that each integrator implements, and the orders that it shows."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

import polars as pl

from omegadot.reports.page.tables import Row, Table, Value, channel_name, run_heads
from omegadot.reports.record.record import Record
from omegadot.reports.summary.provenance import Sources
from omegadot.reports.text.numbers import short, times

_CHANNELS = ("omega", "attitude", "energy", "angular_momentum", "linear_momentum", "position")
_JUDGED = ("pass", "fail")
Key = tuple[str, str, str]


def _key(row: Mapping[str, Any]) -> Key:
    return row["engine"], row.get("setup") or "physics", row["integrator"] or ""


def _declared(record: Record) -> dict[Key, Counter[str]]:
    """How often each integrator declares which scheme: it may depend on the system."""
    found: dict[Key, Counter[str]] = {}
    for task in record.run["tasks"]:
        if task.get("scheme"):
            found.setdefault(_key(task), Counter())[task["scheme"]] += 1
    return found


def scheme_table(record: Record, sources: Sources) -> Table:
    """One row an integrator, over all scenarios and steps: does it implement the declared scheme?

    In how many runs, with what largest deviation as a fraction of the round-off bound, and in
    omega and attitude. The reference is left out: the others are compared with it.
    """
    metrics = _of_runs(record).filter(pl.col("engine") != "reference")
    matches = _by_key(metrics.filter(pl.col("metric") == "match"))
    deviations = _by_key(metrics.filter(pl.col("metric") == "unexplained_max"))
    declared = _declared(record)
    rows = []
    for key, found in matches.items():
        heads = (*_heads(key), _named(declared.get(key, Counter())))
        largest = (_largest(deviations.get(key, []), channel) for channel in ("omega", "attitude"))
        rows.append(Row(heads, (*_equal_cells(found), *largest), _source(key, sources)))
    return Table(
        ("engine", "integrator", "scheme"),
        (("implemented in", 1), ("max. deviation from the scheme", 3)),
        (
            "runs that match, of those judged",
            "fraction of round-off bound",
            "deviation in omega, relative",
            "deviation in attitude, rad",
        ),
        tuple(rows),
    )


def order_table(record: Record, sources: Sources) -> Table:
    """One row an integrator: the range of its observed orders over all scenarios, by channel."""
    metrics = _of_runs(record)
    orders = _by_key(metrics.filter(pl.col("metric") == "observed_order"))
    rows = [
        Row(_heads(key), tuple(_order_cell(found, c) for c in _CHANNELS), _source(key, sources))
        for key, found in orders.items()
    ]
    return Table(
        ("engine", "integrator"),
        (("observed order (declared)", len(_CHANNELS)),),
        tuple(map(channel_name, _CHANNELS)),
        tuple(rows),
    )


def _of_runs(record: Record) -> pl.DataFrame:
    return record.metrics.filter(
        pl.col("integrator").is_not_null() & pl.col("gate").is_in(["scheme", "trajectory"])
    )


def _source(key: Key, sources: Sources) -> int:
    return sources.number(dict(zip(("engine", "setup", "integrator"), key, strict=True)))


def _heads(key: Key) -> tuple[str, ...]:
    return run_heads((key[0], "", key[1], key[2], None, None))


def _named(declared: Counter[str]) -> str:
    """The scheme that is declared, and those declared for some systems instead."""
    if not declared:
        return "none declared"
    (usual, _), *others = declared.most_common()
    message = ", ".join(f"{name} in {times(count, 'run')}" for name, count in others)
    return f"{usual} ({message})" if message else usual


def _by_key(metrics: pl.DataFrame) -> dict[Key, list[dict[str, Any]]]:
    names = ("engine", "setup", "integrator")
    parts = metrics.partition_by(names, as_dict=True, maintain_order=True)
    return {key: part.to_dicts() for key, part in parts.items()}


def _equal_cells(matches: list[dict[str, Any]]) -> tuple[Value, Value]:
    judged = [row for row in matches if row["verdict"] in _JUDGED]
    equal = sum(row["verdict"] == "pass" for row in judged)
    mark = "fail" if equal < len(judged) else ""
    text = f"{equal} of {len(judged)}" if judged else "–"
    values = [row["value"] for row in judged if row["value"] is not None]
    largest = Value(short(max(values, default=None)))
    return Value(f"{text} ✗ fail" if mark else text, mark), largest


def _largest(rows: list[dict[str, Any]], channel: str) -> Value:
    own = [row["value"] for row in rows if row["channel"] == channel]
    finite = [value for value in own if value is not None and value == value]
    return Value(short(max(finite, default=None)))


def _order_cell(rows: list[dict[str, Any]], channel: str) -> Value:
    """The range of the orders that were judged; – where no sweep shows one."""
    own = [r for r in rows if r["channel"] == channel and r["verdict"] in _JUDGED]
    judged = [r for r in own if r["value"] is not None]
    if not judged:
        return Value("–")
    low, high = (f"{pick(r['value'] for r in judged):z.2f}" for pick in (min, max))
    bounds = sorted({r["bound"] for r in judged if r["bound"] is not None})
    span = low if low == high else f"{low} … {high}"
    failed = "fail" if any(r["verdict"] == "fail" for r in judged) else ""
    text = f"{span} ({', '.join(f'{bound:.0f}' for bound in bounds)})"
    return Value(f"{text} ✗ fail" if failed else text, failed)
