"""The verdict in one sentence, computed from the summary and claiming no more than it holds."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from omegadot.reports.record.schema import YARDSTICKS
from omegadot.reports.summary.figures import Figure, size
from omegadot.reports.summary.summary import Cell, Summary
from omegadot.reports.text.numbers import degrees, knob, listed, quantity, short, times

_FEW = 3  # names in one sentence
_MANY = 6  # names that a headline lists before it counts them: the table below has all
_MORE = "The errors over time differ more. "


def headline(summary: Summary) -> str:
    """Which engines agree with the equations and how closely, which fail where: one sentence."""
    return _verdict(summary, _judged_engines(summary))


def remarks(summary: Summary) -> list[str]:
    """What belongs with the headline: what is missing, and the range of the attitude errors."""
    message = [] if summary.complete else ["Partial record: the run was interrupted."]
    # A large error of sound engines has a sentence of its own.
    spread = "" if summary.accuracy else _spread(summary)
    return [*message, *summary.notes, *([spread] if spread else []), *_remainder(summary)]


def truth(summary: Summary) -> list[str]:
    """How the exact solutions were computed: one sentence, none where there are none."""
    kinds = [f"{name} on {count}" for name, count in sorted(summary.truths.items())]
    if not kinds:
        return []
    return [f"Exact solution: {listed(kinds)} of {times(len(summary.scenarios), 'scenario')}."]


def step_notes(engines: Iterable[Mapping[str, Any]]) -> list[str]:
    """What the times of an engine are those of, where all its integrators have one note."""
    found = []
    for engine in engines:
        kinds = {integrator.get("note") for integrator in engine.get("integrators") or ()}
        if engine["name"] not in YARDSTICKS and len(kinds) == 1 and (note := kinds.pop()):
            found.append(f"{engine['name']}: the time of a step is that of {note}")
    return found


def _judged_engines(summary: Summary) -> dict[str, list[Cell]]:
    """Cells per column; the yardsticks are left out unless they alone ran or they fail."""
    every = [(column, cell) for (_, column), cell in summary.cells.items()]
    judged = [(c, cell) for c, cell in every if c.engine not in YARDSTICKS or cell.status == "fail"]
    cells: dict[str, list[Cell]] = {}
    for column, cell in judged or every:
        cells.setdefault(column.label, []).append(cell)
    return cells


def _verdict(summary: Summary, engines: dict[str, list[Cell]]) -> str:
    failing = [name for name, cells in engines.items() if any(c.status == "fail" for c in cells)]
    if failing:
        verb = "fails" if len(failing) == 1 else "fail"
        named = _failing(summary, failing)
        if len(engines) == 1:
            return f"{named.replace(', on ', ' fails on ', 1)}."
        count = f"{len(failing)} of {times(len(engines), 'engine')}"
        return f"{count} {verb}: {named}.{_open(engines, failing)}"
    measured = {name: worst for name, cells in engines.items() if (worst := _residual(cells))}
    passed = {n for n, cells in engines.items() if any(map(_holds, cells))}
    # A declared exception is a known failure: such an engine is not reported as agreeing.
    excused = [n for n, cells in engines.items() if any(c.runs.get("declared") for c in cells)]
    agreeing = [name for name in measured if name in passed and name not in excused]
    without = [name for name in engines if name in passed and name not in (*measured, *excused)]
    if excused and not agreeing:
        return f"Every gate holds except for declared exceptions: {listed(excused)}."
    if not agreeing:
        if not without:
            return "No verdict: no run of an engine was judged on the equation of motion."
        return f"{_without(without)}{_open(engines, without)}"
    largest = max((measured[name] for name in agreeing), key=size)
    named = {1: agreeing[0], 2: "Both engines"}.get(len(agreeing), f"All {len(agreeing)} engines")
    if len(agreeing) < len(engines):
        named = f"{listed(agreeing)} (of {times(len(engines), 'engine')})"
        if len(agreeing) > _MANY:
            named = f"{len(agreeing)} of {len(engines)} engines"
    verb = "agrees" if len(agreeing) == 1 else "agree"
    apart = f" Declared exceptions: {listed(excused)}." if excused else ""
    apart += f" {_without(without)}" if without else ""
    apart += _open(engines, [*agreeing, *excused, *without])
    return (
        f"{named} {verb} with the Newton–Euler equations at identical states: the largest "
        f"omega-dot residual is {quantity(largest.value, largest.unit)} "
        f"({largest.engine} on {largest.scenario}).{apart}"
    )


def _without(names: Sequence[str]) -> str:
    """Of engines that pass, and give no omega-dot that could be compared."""
    holds, gives = ("holds", "gives") if len(names) == 1 else ("hold", "give")
    who = listed(list(names)) if len(names) <= _MANY else f"{len(names)} engines"
    return f"{who} {holds} every gate, and {gives} no omega-dot at a state."


def _holds(cell: Cell) -> bool:
    """Whether something was judged and holds: the equation needs no step, so it is of runs that
    diverged too.
    """
    return bool(cell.runs.get("pass") or (cell.runs.get("diverged") and cell.residual))


def _open(engines: dict[str, list[Cell]], named: Sequence[str]) -> str:
    """The engines besides those that are named on which there is no verdict; "" without any."""

    def is_judged(cells: list[Cell]) -> bool:
        passed = any(map(_holds, cells)) and any(c.residual for c in cells)
        return passed or any(c.runs.get("declared") for c in cells)

    open_ = [n for n, cells in engines.items() if n not in named and not is_judged(cells)]
    texts = [f"{name} ({_outcomes(engines[name])})" for name in open_]
    return f" No verdict on {listed(texts)}." if texts else ""


def _outcomes(cells: list[Cell]) -> str:
    """How the runs of an engine ended that give no verdict."""
    ends = (c.status.replace("-", " ") for c in cells)
    return listed(list(dict.fromkeys("no equation" if end == "pass" else end for end in ends)))


def _failing(summary: Summary, engines: list[str]) -> str:
    """The failing engines, each with its own scenarios where they differ and are few."""
    places: dict[str, list[str]] = {name: [] for name in engines}
    for (scenario, column), cell in summary.cells.items():
        if cell.status == "fail" and scenario not in places[column.label]:
            places[column.label].append(scenario)
    own = {name: sorted(found) for name, found in places.items()}
    first = own[engines[0]]
    if all(found == first for found in own.values()):
        total = times(len(summary.scenarios), "scenario")
        where = listed(first) if len(first) <= _FEW else f"{len(first)} of {total}"
        return f"{listed(engines)}, on {where}"
    if len(engines) > _FEW or any(len(found) > _FEW for found in own.values()):
        return listed(engines)
    return listed([f"{name} (on {listed(found)})" for name, found in own.items()])


def _residual(cells: list[Cell]) -> Figure | None:
    return max((c.residual for c in cells if c.residual), key=size, default=None)


def which_step(summary: Summary) -> str:
    """At which step the errors of a summary are."""
    return "at the one step" if summary.one_step else "at the finest step"


def _spread(summary: Summary) -> str:
    engines = _judged_engines(summary)
    failing = {name for name, cells in engines.items() if any(c.status == "fail" for c in cells)}
    sound = [cells for name, cells in engines.items() if name not in failing]
    measured = sound or list(engines.values())
    ranges = [cell.attitude for cells in measured for cell in cells if cell.attitude]
    if not ranges:
        return ""
    largest = max((r.worst for r in ranges), key=size)
    best = min((r.best for r in ranges if r.best.scenario == largest.scenario), key=size)
    if best.value == largest.value:
        return ""
    more = "" if failing else _MORE
    step = which_step(summary)
    whose = f"Of the engines that pass, {step}" if failing and sound else step.capitalize()
    return (
        f"{more}{whose} the attitude error on "
        f"{largest.scenario} ranges from {_run(best)} to {_run(largest)}."
    )


def _run(figure: Figure) -> str:
    name = " ".join(filter(None, (figure.engine, figure.integrator)))
    run = ", ".join(filter(None, (name, knob(figure.timestep, figure.accuracy))))
    return f"{short(figure.value)} rad ({degrees(figure.value)} deg, {run})"


def _remainder(summary: Summary) -> list[str]:
    message = []
    runs = summary.runs + summary.yardsticks
    declared = runs.get("declared", 0)
    if declared:
        message.append(f"{times(declared, 'declared exception')}.")
    total = sum(runs.values())
    skipped = total - sum(runs[status] for status in ("pass", "fail", "declared"))
    if skipped:
        message.append(
            f"{skipped} of {times(total, 'run')} gave no verdict; the reasons are listed."
        )
    return message
