"""The verdict in one sentence, computed from the summary and claiming no more than it holds."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from omegadot.reports.record.schema import YARDSTICKS
from omegadot.reports.summary.figures import Figure, size
from omegadot.reports.summary.judged_engines import JudgedEngines, judged_engines
from omegadot.reports.summary.summary import Cell, Summary
from omegadot.reports.text.numbers import degrees, knob, listed, quantity, short, times

_FEW = 3  # names in one sentence
_MANY = 6  # names that a headline lists before it counts them: the table below has all
_MORE = "The errors over time differ more. "


def headline(summary: Summary) -> str:
    """Which engines agree with the equations and how closely, which fail where: one sentence."""
    return _verdict(summary, judged_engines(summary))


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


def _verdict(summary: Summary, engines: JudgedEngines) -> str:
    if failing := engines.failing:
        named = engines.named(failing)
        text = _failing(summary, named)
        if len(engines) == 1:
            return f"{text.replace(', on ', ' fails on ', 1)}."
        verb = "fails" if len(named) == 1 else "fail"
        count = f"{len(named)} of {times(len(engines), 'engine')}"
        return f"{count} {verb}: {text}.{_open(engines, failing)}"
    cells = engines.cells
    measured = {name: worst for name, own in cells.items() if (worst := _residual(own))}
    passed = {n for n, own in cells.items() if any(map(_holds, own))}
    # A declared exception is a known failure: such an engine is not reported as agreeing.
    excused = [n for n, own in cells.items() if any(c.runs.get("declared") for c in own)]
    agreeing = [name for name in measured if name in passed and name not in excused]
    without = [name for name in cells if name in passed and name not in (*measured, *excused)]
    if excused and not agreeing:
        known = listed(list(engines.named(excused)))
        return f"Every gate holds except for declared exceptions: {known}."
    if not agreeing:
        if not without:
            return "No verdict: no run of an engine was judged on the equation of motion."
        return f"{_without(engines, without)}{_open(engines, without)}"
    largest = max((measured[name] for name in agreeing), key=size)
    who, verb = _agreeing(engines, agreeing)
    apart = f" Declared exceptions: {listed(list(engines.named(excused)))}." if excused else ""
    apart += f" {_without(engines, without)}" if without else ""
    apart += _open(engines, [*agreeing, *excused, *without])
    return (
        f"{who} {verb} with the Newton–Euler equations at identical states: the largest "
        f"omega-dot residual is {quantity(largest.value, largest.unit)} "
        f"({largest.engine} on {largest.scenario}).{apart}"
    )


def _agreeing(engines: JudgedEngines, labels: Sequence[str]) -> tuple[str, str]:
    """Those that agree, and the verb; of many their number, and whose setups do not all agree."""
    names, whole = list(engines.named(labels)), engines.whole(labels)
    verb = "agrees" if len(names) == 1 else "agree"
    if whole == len(engines):
        return {1: names[0], 2: "Both engines"}.get(whole, f"All {whole} engines"), verb
    if len(names) <= _MANY:
        return f"{listed(names)} (of {times(len(engines), 'engine')})", verb
    parts = [name for name in names if name not in engines.labels]
    return listed([f"{whole} of {len(engines)} engines", *parts]), verb


def _without(engines: JudgedEngines, labels: Sequence[str]) -> str:
    """Of engines that pass, and give no omega-dot that could be compared."""
    names = list(engines.named(labels))
    holds, gives = ("holds", "gives") if len(names) == 1 else ("hold", "give")
    who = listed(names) if len(names) <= _MANY else f"{len(names)} engines"
    return f"{who} {holds} every gate, and {gives} no omega-dot at a state."


def _holds(cell: Cell) -> bool:
    """Whether something was judged and holds: the equation needs no step, so it is of runs that
    diverged too.
    """
    return bool(cell.runs.get("pass") or (cell.runs.get("diverged") and cell.residual))


def _open(engines: JudgedEngines, named: Sequence[str]) -> str:
    """The engines besides those that are named on which there is no verdict; "" without any."""

    def is_judged(cells: list[Cell]) -> bool:
        passed = any(map(_holds, cells)) and any(c.residual for c in cells)
        return passed or any(c.runs.get("declared") for c in cells)

    open_ = [n for n, cells in engines.cells.items() if n not in named and not is_judged(cells)]
    texts = [
        f"{name} ({_outcomes([cell for label in own for cell in engines.cells[label]])})"
        for name, own in engines.named(open_).items()
    ]
    return f" No verdict on {listed(texts)}." if texts else ""


def _outcomes(cells: list[Cell]) -> str:
    """How the runs of an engine ended that give no verdict."""
    ends = (c.status.replace("-", " ") for c in cells)
    return listed(list(dict.fromkeys("no equation" if end == "pass" else end for end in ends)))


def _failing(summary: Summary, engines: Mapping[str, list[str]]) -> str:
    """The failing engines, each with its own scenarios where they differ and are few.

    engines: by name the labels of the columns.
    """
    failing = [where for where, cell in summary.cells.items() if cell.status == "fail"]
    own = {
        name: sorted({s for s, c in failing if c.label in labels})
        for name, labels in engines.items()
    }
    names = list(own)
    first = own[names[0]]
    if all(found == first for found in own.values()):
        total = times(len(summary.scenarios), "scenario")
        where = listed(first) if len(first) <= _FEW else f"{len(first)} of {total}"
        return f"{listed(names)}, on {where}"
    if len(names) > _FEW or any(len(found) > _FEW for found in own.values()):
        return listed(names)
    return listed([f"{name} (on {listed(found)})" for name, found in own.items()])


def _residual(cells: list[Cell]) -> Figure | None:
    return max((c.residual for c in cells if c.residual), key=size, default=None)


def which_step(summary: Summary) -> str:
    """At which step the errors of a summary are."""
    return "at the one step" if summary.one_step else "at the finest step"


def _spread(summary: Summary) -> str:
    engines = judged_engines(summary)
    failing = engines.failing
    sound = [cells for name, cells in engines.cells.items() if name not in failing]
    measured = sound or list(engines.cells.values())
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
