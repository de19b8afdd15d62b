"""A scored trace, and the conventions of one that fit, for a person and for machines."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import typer
from rich.table import Table
from rich.text import Text

from omegadot.commands.run.print_run import exit_code
from omegadot.commands.score.judged import Judged
from omegadot.commands.score.own_units import in_own_unit
from omegadot.commands.score.score import ScoreResult
from omegadot.commands.score.shift import scatter
from omegadot.commands.streams import on_one_line
from omegadot.reports.record.record import PAGE
from omegadot.reports.record.run_json import dump_json
from omegadot.reports.text.text_grid import plain_console
from omegadot.written import written

if TYPE_CHECKING:
    from omegadot.commands.score.detection.detect import Detected
    from omegadot.commands.score.detection.reading import Reading

STYLES = {"pass": "green", "fail": "bold red", "info": "default"}
WIDTH_WHEN_PIPED = 200
MOST_SHOWN = 8  # readings that fit alike


def print_text(result: ScoreResult) -> None:
    """The table of channels, then the sentences, and where the page is."""
    console = plain_console(WIDTH_WHEN_PIPED)
    found, times = result.found, result.found.trace.times
    console.print(
        Text(
            f"{result.name} ({found.reading.table.file}, {len(times)} samples from "
            f"{written(times[0])} to "
            f"{written(times[-1])} s) against the exact solution of {found.case.name} "
            f"({found.truth.source})"
        )
    )
    console.print(_table(found))
    for sentence in result.sentences:
        console.print(Text(sentence))
    _print_others(result)
    if result.folder is not None:
        typer.echo(f"Report: {on_one_line(result.folder / PAGE)}")
    if result.note:
        typer.echo(on_one_line(result.note))


def _print_others(result: ScoreResult) -> None:
    others = [task for task in result.record.tasks if task.engine != result.name]
    failed = [task for task in others if "fail" in task.gates.values() or task.broken]
    if others:
        engines = ", ".join(dict.fromkeys(task.engine for task in others))
        ended = f"{len(failed)} of them failed" if failed else "none failed"
        typer.echo(f"Other engines: {engines}; {len(others)} runs, {ended}.")


def _table(found: Judged) -> Table:
    table = Table(box=None, padding=(0, 2, 0, 0), header_style="bold")
    for head in ("channel", "largest", "at the end", "rms", "resolution", "unit", "", "why"):
        table.add_column(head, no_wrap=True)
    for channel in found.error:
        score = in_own_unit(found, channel)
        table.add_row(
            channel.replace("_", " "),
            *(written(value, 4) for value in (score.max, score.end, score.rms, score.bound)),
            score.unit,
            Text(score.verdict, STYLES[score.verdict]),
            Text(score.note),
        )
    return table


def print_json(result: ScoreResult) -> None:
    """What the text states, as numbers. SI units; omega in rad/s."""
    found, shift = result.found, result.shift
    late = shift and {
        "seconds": shift.seconds,
        "open": shift.open,
        "before": shift.before,
        "after": shift.after,
        "of": shift.of,
        "unit": "rad/s" if shift.of == "omega" else "rad",
        "attitude_after": shift.attitude_after,
        "noise": scatter(shift),
        "explains": shift.explains,
        "note": shift.note,
    }
    printed = {
        "schema": result.record.run["schema"],
        "exit_code": exit_code(result),
        "folder": str(result.folder),
        "note": result.note,
        "report": str(result.folder / PAGE) if result.folder else None,
        "scenario": found.case.name,
        "trace": result.name,
        "samples": len(found.trace.times),
        "truth": found.truth.source,
        "channels": {channel: vars(score) for channel, score in result.channels.items()},
        "not_given": result.not_given,
        "shift": late,
        "turned": found.turned and {**vars(found.turned), "vector": found.turned.vector.tolist()},
        "shifted": found.shifted
        and {**vars(found.shifted), "offset": found.shifted.offset.tolist()},
        "causes": found.causes,
        "held": [vars(held) for held in found.held],
        "requirements": [vars(row) for row in result.requirements],
        "sentences": result.sentences,
        "tasks": result.record.run["tasks"],
    }
    typer.echo(dump_json(printed))


def print_detected(found: Detected, trace: Path, scenario: str, *, as_json: bool) -> int:
    """Print which conventions fit, and the options to pass.

    0 where one does, 1 where none or more than one do.
    """
    fitting = found.fitting
    code = 0 if len(fitting) == 1 else 1
    if not as_json:
        typer.echo("\n".join(_lines(trace, scenario, found, fitting)))
        return code
    fit, others = (
        [{"options": r.options(), "misfit": r.misfit} for r in known]
        for known in (fitting, found.others[:1])
    )
    printed = {
        "exit_code": code,
        "ambiguous": len(fitting) > 1,
        "fitting": fit,
        "runner_up": others[0] if others else None,
        "turn": found.turn,
    }
    typer.echo(dump_json(printed))
    return code


def _lines(trace: Path, scenario: str, found: Detected, fitting: list[Reading]) -> list[str]:
    if not fitting:
        return [
            f"No convention that was tried fits {trace} to {scenario}: "
            "is it a motion of that scenario, from its start?"
        ]
    if len(fitting) > 1:
        return _ambiguous(found, fitting)
    best = fitting[0]
    lines = [
        f"One convention fits; its error is {written(best.misfit, 2)} of the size of the motion:",
        f"  omegadot score {trace} --scenario {scenario} {' '.join(best.options())}",
    ]
    if found.others:
        second = found.others[0]
        times = second.misfit / best.misfit if best.misfit > 0.0 else math.inf
        lines.append(
            f"The next best is {written(times, 1)} times as far off ({written(second.misfit, 2)}): "
            f"{' '.join(_different(second, best))}"
        )
    for part, name in ((best.attitude, "an attitude"), (best.omega, "an angular velocity")):
        if part is None:
            lines.append(f"No columns were found that fit as {name}.")
    return lines


def _ambiguous(found: Detected, fitting: list[Reading]) -> list[str]:
    why = "This motion does not distinguish them"
    if found.turn < 0.1:
        why = f"The body turns by {written(found.turn, 2)} rad only, too little to distinguish them"
    lines = [f"Ambiguous: {len(fitting)} conventions fit alike. {why}; nothing is guessed."]
    lines += [f"  {' '.join(reading.options())}" for reading in fitting[:MOST_SHOWN]]
    more = len(fitting) - MOST_SHOWN
    return lines + ([f"  and {more} more"] if more > 0 else [])


def _different(second: Reading, best: Reading) -> list[str]:
    own = [option for option in second.options() if option not in best.options()]
    left = [option for option in best.options() if option not in second.options()]
    return own or [f"without {' '.join(left)}"]
