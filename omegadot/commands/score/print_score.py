"""A scored trace for a person, as a table with sentences, and the same for machines."""

from __future__ import annotations

import sys

import typer
from rich.console import Console
from rich.table import Table
from rich.text import Text

from omegadot.commands.run.print_run import exit_code
from omegadot.commands.score.judged import Judged
from omegadot.commands.score.score import ScoreResult
from omegadot.commands.score.sentences import in_own_unit
from omegadot.commands.score.shift import scatter
from omegadot.reports.record.record import PAGE
from omegadot.reports.record.run_json import dump_json

STYLES = {"pass": "green", "fail": "bold red", "info": "default"}
WIDTH_WHEN_PIPED = 200


def print_text(result: ScoreResult) -> None:
    """The table of channels, then the sentences, and where the page is."""
    console = Console(width=None if sys.stdout.isatty() else WIDTH_WHEN_PIPED, highlight=False)
    found, times = result.found, result.found.trace.times
    console.print(
        Text(
            f"{result.name} ({found.reading.table.file}, {len(times)} samples from {times[0]:g} to "
            f"{times[-1]:g} s) against the exact solution of {found.case.name} "
            f"({found.truth.source})"
        )
    )
    console.print(_table(found))
    for sentence in result.sentences:
        console.print(Text(sentence))
    _print_others(result)
    if result.folder is not None:
        typer.echo(f"Report: {result.folder / PAGE}")


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
            *(f"{value:.4g}" for value in (score.max, score.end, score.rms, score.bound)),
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
        "report": str(result.folder / PAGE) if result.folder else None,
        "scenario": found.case.name,
        "trace": result.name,
        "samples": len(found.trace.times),
        "truth": found.truth.source,
        "channels": {channel: vars(score) for channel, score in result.channels.items()},
        "not_given": result.not_given,
        "shift": late,
        "requirements": [vars(row) for row in result.requirements],
        "sentences": result.sentences,
        "tasks": result.record.run["tasks"],
    }
    typer.echo(dump_json(printed))
