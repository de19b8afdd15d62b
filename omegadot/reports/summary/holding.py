"""What is known of a failing engine without a cause: orders that it shows, and what of it holds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isfinite
from typing import Any

from omegadot.reports.record.schema import GATES
from omegadot.reports.summary.not_tried import MOST_NAMED, parts_of
from omegadot.reports.summary.reasons import failing_gates, tests_motion
from omegadot.reports.summary.unseen import OF_STEPS
from omegadot.reports.text.numbers import first, listed, plain

_PLACES = 3  # scenarios in one sentence
PIVOT = "a pivot"
Row = Mapping[str, Any]


def facts(rows: Sequence[Row], tasks: Sequence[Row], gate: str) -> str:
    """The orders below the declared ones, and which gates and integrators hold; "" for neither.

    rows: those that fail, of one engine.  tasks: all of its.  gate: the first that fails.
    """
    return "; ".join(filter(None, (_orders(rows), _holding(tasks, gate))))


def _orders(rows: Sequence[Row]) -> str:
    """Of the first integrator that has too low a one in attitude, or else in any channel."""
    low = [row for row in rows if row["metric"] == "observed_order" and row["bound"] is not None]
    low = [row for row in low if row["value"] is not None and row["value"] < row["bound"]]
    own = [row for row in low if row["channel"] == "attitude"] or low
    own = [row for row in own if row["integrator"] == own[0]["integrator"]]
    if not own or not all(isfinite(row["value"]) for row in own):
        return ""
    ends = dict.fromkeys(f"{pick(row['value'] for row in own):.2f}" for pick in (min, max))
    declared = plain(own[0]["bound"])
    channel = own[0]["channel"].replace("_", " ")
    return f"{own[0]['integrator']} shows order {' to '.join(ends)} in {channel}, not {declared}"


def _holding(tasks: Sequence[Row], gate: str) -> str:
    """The gates before the first that fails, but for the model's, and the sound integrators."""
    before = GATES[1 : max(1, GATES.index(gate))]
    verdicts = {one: [(task.get("gates") or {}).get(one) for task in tasks] for one in before}
    gates = [one for one, own in verdicts.items() if "pass" in own and "fail" not in own]
    names = [*dict.fromkeys(task["integrator"] for task in tasks if task["integrator"])]
    sound = [
        name
        for name in names
        if all(
            task["outcome"] == "ok" and tests_motion(task) and not failing_gates(task)
            for task in tasks
            if task["integrator"] == name
        )
    ]
    texts = [f"{listed(gates)} gate{'s' * (len(gates) > 1)}"] if gates else []
    texts += [first(sound, _PLACES)] if sound else []
    return f"{' and '.join(texts)} hold{'s' * (len(gates) + len(sound) == 1)}" if texts else ""


def scope(run: Mapping[str, Any], tasks: Sequence[Row], worst: Row, places: Sequence[str]) -> str:
    """On which scenarios a gate holds, and what only those have on which it does not; "" for none.

    tasks: all of the engine.  worst: its worst row.  places: the scenarios on which the gate fails.
    """
    gate: str = worst["gate"]
    held: dict[str, set[str]] = {}
    for task in tasks:
        held.setdefault(task["scenario"], set()).add((task.get("gates") or {}).get(gate) or "")
    holds = [name for name, own in held.items() if "pass" in own and "fail" not in own]
    holds = [name for name in holds if name not in places]
    if not holds:
        return ""
    where = listed(holds) if len(holds) <= _PLACES else first(holds, _PLACES)
    # A step's fault may need a state that is far from a scenario's own.
    text = f"the {gate} gate on {where}" + ", from the states tried" * bool(
        worst["metric"] == OF_STEPS
    )
    alone = _alone(run, places, holds)
    if not alone:
        return text
    named = listed(alone) if len(alone) <= MOST_NAMED else first(alone, MOST_NAMED)
    return f"{text}; only where it fails is there {named}"


def _alone(run: Mapping[str, Any], failing: Sequence[str], holding: Sequence[str]) -> list[str]:
    """What every system has on which a gate fails, and none on which it holds."""
    entries = {entry["name"]: entry for entry in run["scenarios"] if entry.get("system")}
    if not {*failing, *holding} <= entries.keys():
        return []
    fails, holds = ([_parts(entries[name]) for name in names] for names in (failing, holding))
    found = [
        name for name in fails[0] if all(p[name] for p in fails) and not any(p[name] for p in holds)
    ]
    return [name for name in found if not (PIVOT in found and name.startswith(f"{PIVOT} "))]


def _parts(entry: Mapping[str, Any]) -> dict[str, bool]:
    initial = (entry.get("definition") or {}).get("initial") or {}
    parts = parts_of(entry["system"], initial)
    return {PIVOT: entry["system"]["pivot"] is not None, **parts}
