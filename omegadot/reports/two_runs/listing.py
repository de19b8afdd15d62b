"""The parts of a comparison as rows of text, shared by terminal, Markdown and page."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from omegadot.reports.record.schema import YARDSTICKS
from omegadot.reports.text.numbers import engine_name, first, knob, plain, times
from omegadot.reports.two_runs.change import Change, from_to, grouped, name_of
from omegadot.reports.two_runs.comparison import Comparison
from omegadot.reports.two_runs.sides import RunKey, Side, Task

_CHANGE_HEADS = ("engine", "integrator", "what", "largest at", "change", "total", "reason now")
_PRESENCE_HEADS = ("engine", "integrator", "steps", "outcome", "runs", "scenarios", "reason")
_SETTING_HEADS = ("", "first", "second")
_COST_HEADS = ("engine", "integrator", "median", "quartiles", "runs")
_NAMED = 4

Rows = list[tuple[str, ...]]


@dataclass(frozen=True)
class Part:
    """A table of a comparison. more: of its title, where there is room."""

    anchor: str
    title: str
    more: str
    heads: tuple[str, ...]
    rows: Rows


def parts_of(comparison: Comparison) -> list[Part]:
    """The tables; one without rows is left out."""
    presences = _presences(comparison.vanished), _presences(comparison.appeared)
    found = (
        Part("worse", "Worse", "", _CHANGE_HEADS, _change_rows(comparison.worse)),
        Part("better", "Better", "", _CHANGE_HEADS, _change_rows(comparison.better)),
        Part("vanished", "Vanished", ": in the first record alone", _PRESENCE_HEADS, presences[0]),
        Part("appeared", "Appeared", ": in the second record alone", _PRESENCE_HEADS, presences[1]),
        Part("settings", "Different settings", "", _SETTING_HEADS, _settings(comparison)),
        Part("cost", "Time per step, second over first", "", _COST_HEADS, _costs(comparison)),
    )
    return [part for part in found if part.rows]


def _change_rows(changes: Iterable[Change]) -> Rows:
    """One row an engine, integrator, gate and channel, with the largest of its changes."""
    return [_change_row(own) for own in grouped(changes)]


def _change_row(changes: list[Change]) -> tuple[str, ...]:
    worst, count = changes[0], len(changes)
    key, scenarios = worst.key, len({change.key.scenario for change in changes})
    where = ", ".join(filter(None, (key.scenario, knob(key.timestep, key.accuracy))))
    in_all = f"{times(count, 'value' if worst.metric else 'run')} on {times(scenarios, 'scenario')}"
    total = in_all if count > 1 else ""
    return name_of(key), key.integrator, worst.what, where, from_to(worst), total, worst.why


def _presences(tasks: Iterable[Task]) -> Rows:
    """Runs that one record alone has: one row an engine, integrator and outcome."""
    groups: dict[tuple[str, str, str, str], list[RunKey]] = {}
    for task in tasks:
        key, why = task.key, "" if task.status == "pass" else task.why
        groups.setdefault((name_of(key), key.integrator, task.status, why), []).append(key)
    found: Rows = []
    for (engine, integrator, status, why), own in groups.items():
        steps = list(dict.fromkeys(knob(key.timestep, key.accuracy) for key in own))
        scenarios = list(dict.fromkeys(key.scenario for key in own))
        shown = first(list(filter(None, steps)), _NAMED), first(scenarios, _NAMED)
        found.append((engine, integrator, shown[0], status, str(len(own)), shown[1], why))
    return found


def _settings(comparison: Comparison) -> Rows:
    return [(d.what, d.was, d.now) for d in comparison.settings]


def _costs(comparison: Comparison) -> Rows:
    return [
        (c.engine, c.integrator, f"{c.median:.2f}", f"{c.low:.2f} … {c.high:.2f}", str(c.runs))
        for c in comparison.costs
    ]


def engines_of(run: Mapping[str, Any]) -> dict[str, str]:
    """By engine that is installed: its name and version."""
    return {
        entry["name"]: engine_name(entry["name"], entry.get("version") or "")
        for entry in run["engines"]
        if entry.get("installed") is not False
    }


def side_facts(side: Side) -> str:
    """A record in a line: when, with what and where it was made."""
    run = side.run
    machine = run.get("machine") or {}
    seed = run.get("seed")
    facts = (
        str(run.get("created") or ""),
        f"omegadot {run['omegadot']}" if run.get("omegadot") else "",
        *(text for name, text in engines_of(run).items() if name not in YARDSTICKS),
        str(machine.get("processor") or ""),
        f"seed {plain(seed)}" if isinstance(seed, int | float) else "",
        "" if side.complete else "interrupted",
    )
    return ", ".join(filter(None, facts))


def remarks(comparison: Comparison) -> list[str]:
    """What belongs with the headline."""
    message = []
    if comparison.redefined:
        names = ", ".join(sorted(comparison.redefined))
        message.append(f"Redefined under the same name, so only verdicts are compared: {names}.")
    for side, term in ((comparison.was, "first"), (comparison.now, "second")):
        if not side.complete:
            message.append(f"The {term} record is partial: its run was interrupted.")
    return message
