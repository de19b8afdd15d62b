"""What ``omegadot run`` prints when it is done, and how it exits."""

from __future__ import annotations

from collections import Counter
from typing import Any

import typer

from omegadot.commands import options
from omegadot.commands.run.result import RunResult
from omegadot.commands.streams import on_one_line
from omegadot.reports.record.record import PAGE
from omegadot.reports.record.run_json import dump_json
from omegadot.reports.text.terminal import print_summary


def exit_code(result: RunResult) -> int:
    """0 every gate holds, 1 a gate fails or a declared exception does not hold any more, 3 an
    engine failed to answer or to start, or the record is not where it was requested.

    An engine that is not installed counts only where it was given by name.
    """
    if not result.complete:
        return options.INTERRUPTED
    return options.exit_code(result.passed, result.answered and not result.note)


def print_text(result: RunResult) -> None:
    """A table that is read in ten seconds, and where the page is."""
    print_summary(result.record)
    for problem in result.stale_exceptions:
        typer.echo(f"Declared exception: {problem}")
    if result.folder is not None:
        typer.echo(f"Report: {on_one_line(result.folder / PAGE)}")
    if result.note:
        typer.echo(on_one_line(result.note))


def print_json(result: RunResult) -> None:
    """The verdicts of every task, for machines."""
    run, folder = result.record.run, result.folder
    tasks: list[dict[str, Any]] = run["tasks"]
    printed = {
        "schema": run["schema"],
        "exit_code": exit_code(result),
        "complete": result.complete,
        "folder": str(folder),
        "note": result.note,
        "report": str(folder / PAGE) if folder else None,
        "headline": result.record.headline,
        "outcomes": Counter(task["outcome"] for task in tasks),
        "verdicts": Counter(v for task in tasks for v in task["gates"].values()),
        "stale_exceptions": run.get("stale_exceptions", []),
        "tasks": tasks,
    }
    typer.echo(dump_json(printed))
