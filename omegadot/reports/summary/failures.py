"""The failing engines: which gate, where, by how much, the likeliest cause, and what it costs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import polars as pl

from omegadot.reports.record.record import Record
from omegadot.reports.record.schema import GATES
from omegadot.reports.summary.cost import WHO, cost_of
from omegadot.reports.summary.failed_gate import measure, worst_row
from omegadot.reports.summary.next_command import CHECK, next_command
from omegadot.reports.summary.reasons import cause_of, failing_gates
from omegadot.reports.text.numbers import engine_name, knob, listed, times

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
Row = Mapping[str, Any]


@dataclass(frozen=True)
class EngineFailure:
    """An engine that fails: the first gate that does, and its worst measure there.

    run: the integrator and step that gave it, or whose runs fail where all share it.  extent: in
    how many of its runs this gate fails.  later: the gates after it that fail as well.
    cause: the likeliest, "" where none is known, and then seen: what is known in its place.
    cost: what the failure means for the attitude, next to integrators that pass; "" where it is not
    known.  command: shrinks the failure and looks for its cause, or repeats it; "" without any.
    """

    engine: str
    gate: str
    scenario: str
    run: str
    measured: str
    extent: str
    cause: str
    cost: str
    later: tuple[str, ...] = ()
    seen: str = ""
    command: str = ""

    @property
    def looks_at(self) -> str:
        """What the gate looks at."""
        return LOOKS_AT[self.gate]

    @property
    def purpose(self) -> str:
        """What the command is for."""
        shrinks = self.command.startswith(CHECK)
        return "shrinks it and looks for its cause" if shrinks else "runs it alone"

    @property
    def sentence(self) -> str:
        """All of it in a few sentences."""
        by = f", {self.run}" if self.run else ""
        head = f"{self.engine} fails the {self.gate} gate ({self.looks_at}) in {self.extent}"
        parts = [f"{head}, worst on {self.scenario}{by}: {self.measured}"]
        parts += [f"{self.later_gates} as well"] if self.later else []
        parts += [f"Likely cause: {self.cause}"] if self.cause else []
        parts += [f"No cause was found: {self.seen}"] if self.seen else []
        parts += [f"Cost: {self.cost}"] if self.cost else []
        text = ". ".join(parts) + "."
        return f"{text} Next: {self.command}" if self.command else text

    @property
    def later_gates(self) -> str:
        """The gates after the first that fail, as a clause."""
        one = len(self.later) == 1
        named = f"{listed(self.later)} {'gate fails' if one else 'gates fail'}"
        return f"Its {named}" if self.later else ""


def failures_of(record: Record) -> tuple[EngineFailure, ...]:
    """Every failing engine, in the order of the record."""
    rows = record.metrics.filter(pl.col("verdict") == "fail").to_dicts()
    several = Counter(name for name, *_ in {tuple(row[key] for key in WHO) for row in rows})
    found: dict[tuple[str, ...], list[Row]] = {}
    for row in rows:
        found.setdefault(tuple(row[key] for key in WHO), []).append(row)
    failures = []
    for who, own in found.items():
        engine, version, setup = who
        tasks = [task for task in record.run["tasks"] if task["engine"] == engine]
        failing, worst = list(filter(failing_gates, tasks)), worst_row(own)
        at_gate = [task for task in failing if worst["gate"] in failing_gates(task)]
        others = {row["gate"] for row in own} | {g for t in failing for g in failing_gates(t)}
        failures.append(
            EngineFailure(
                engine_name(engine, version if several[engine] > 1 else "", setup),
                worst["gate"],
                worst["scenario"],
                _run(worst, tasks, at_gate),
                measure(worst),
                f"{len(at_gate)} of {times(len(tasks), 'run')}",
                _likeliest(failing),
                cost_of(record, who, own),
                tuple(g for g in GATES if g in others and GATES.index(g) > _place(worst)),
                _seen(failing),
                next_command(record.run, worst, {task["integrator"] for task in failing}),
            )
        )
    return tuple(failures)


def _place(row: Row) -> int:
    return GATES.index(row["gate"])


def _run(worst: Row, tasks: Sequence[Row], failing: Sequence[Row]) -> str:
    """The run of the worst measure; where integrators share it, those whose runs fail."""
    if worst["integrator"]:
        return ", ".join(filter(None, (worst["integrator"], knob(worst["timestep"], None))))
    here = [task for task in tasks if task["scenario"] == worst["scenario"] and task["integrator"]]
    names = dict.fromkeys(task["integrator"] for task in failing if task in here)
    if len(names) > 1 and len(names) == len({task["integrator"] for task in here}):
        return "every integrator"
    return listed(list(names)) if names else ""


def _likeliest(failing: Sequence[Row]) -> str:
    """The cause that explains most runs, with how many others there are."""
    causes = Counter(filter(None, map(cause_of, failing)))
    known = [(cause, n) for cause, n in causes.most_common() if not cause.startswith(UNKNOWN)]
    if not known:
        return ""
    more = f"; {times(len(known) - 1, 'other cause')} elsewhere" if len(known) > 1 else ""
    return f"{known[0][0].rstrip('.')}{more}"


def _seen(failing: Sequence[Row]) -> str:
    """Where no cause is found of any run, what is known of the most runs in its place."""
    texts = Counter(filter(None, map(cause_of, failing)))
    if not texts or any(not text.startswith(UNKNOWN) for text in texts):
        return ""
    text = texts.most_common(1)[0][0].removeprefix(UNKNOWN)
    return text.lstrip("; ").rstrip(".")
