"""The parts of a comparison as rows of text, shared by terminal, Markdown and page."""

from __future__ import annotations

from collections.abc import Iterable

from omegadot.reports.text.numbers import plain, times
from omegadot.reports.two_runs.change import Change, Group, from_to, grouped, name_of, place
from omegadot.reports.two_runs.comparison import Comparison
from omegadot.reports.two_runs.sides import Side, Task

CHANGE_HEADS = ("engine", "integrator", "what", "largest at", "change", "total", "reason now")
PRESENCE_HEADS = ("engine", "outcome", "runs", "scenarios", "reason")
SETTING_HEADS = ("", "first", "second")
COST_HEADS = ("engine", "integrator", "median", "quartiles", "runs")
COST_NOTE = "Time per step, second over first; reported, not judged."
_SCENARIOS_NAMED = 4

Rows = list[tuple[str, ...]]


def change_rows(changes: Iterable[Change]) -> Rows:
    """One row an engine, integrator, gate and channel, with the largest of its changes."""
    return [_change_row(group) for group in grouped(changes)]


def _change_row(group: Group) -> tuple[str, ...]:
    worst, many = group.worst, group.count > 1
    noun = "value" if worst.metric else "run"
    in_all = f"{times(group.count, noun)} on {times(len(group.scenarios), 'scenario')}"
    return (
        group.engine,
        group.integrator,
        worst.what,
        place(worst),
        from_to(worst),
        in_all if many else "",
        worst.why,
    )


def presence_rows(tasks: Iterable[Task]) -> Rows:
    """Runs that one record alone has: one row an engine and outcome."""
    groups: dict[tuple[str, str, str], list[Task]] = {}
    for task in tasks:
        why = "" if task.status == "pass" else task.why
        groups.setdefault((name_of(task.key), task.status, why), []).append(task)
    rows: Rows = []
    for (engine, status, why), own in groups.items():
        names = list(dict.fromkeys(task.key.scenario for task in own))
        more = len(names) - _SCENARIOS_NAMED
        named = ", ".join(names[:_SCENARIOS_NAMED]) + (f" and {more} more" if more > 0 else "")
        rows.append((engine, status, str(len(own)), named, why))
    return rows


def setting_rows(comparison: Comparison) -> Rows:
    """What the records were made with, where it differs."""
    return [(d.what, d.was, d.now) for d in comparison.settings]


def cost_rows(comparison: Comparison) -> Rows:
    """How the time per step went, with its spread."""
    return [
        (
            cost.engine,
            cost.integrator,
            f"{cost.median:.2f}",
            f"{cost.low:.2f} … {cost.high:.2f}",
            str(cost.runs),
        )
        for cost in comparison.costs
    ]


def side_facts(side: Side) -> str:
    """A record in a line: when, with what and where it was made."""
    run = side.run
    engines = [
        f"{entry['name']} {entry.get('version') or ''}".strip()
        for entry in run["engines"]
        if entry.get("installed") is not False and entry["name"] not in ("exact", "reference")
    ]
    machine = run.get("machine") or {}
    seed = run.get("seed")
    facts = (
        str(run.get("created") or ""),
        f"omegadot {run['omegadot']}" if run.get("omegadot") else "",
        *engines,
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
