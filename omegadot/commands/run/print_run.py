"""What ``omegadot run`` prints when it is done."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import typer

from omegadot.reports.record.record import PAGE, Record
from omegadot.reports.record.run_json import dump_json
from omegadot.reports.summary.headline import headline
from omegadot.reports.summary.summary import summarise
from omegadot.reports.text.terminal import print_summary


def print_text(record: Record, out: Path) -> None:
    """A table that is read in ten seconds, and where the page is."""
    print_summary(record)
    for exception in record.run.get("stale_exceptions", []):
        typer.echo(f"Declared exception: {exception['problem']}")
    typer.echo(f"Report: {out / PAGE}")


def print_json(record: Record, out: Path, code: int) -> None:
    """The verdicts of every task, for machines."""
    tasks: list[dict[str, Any]] = record.run["tasks"]
    verdicts = Counter(v for task in tasks for v in task["gates"].values())
    result = {
        "schema": record.run["schema"],
        "exit_code": code,
        "complete": record.run["complete"],
        "folder": str(out),
        "report": str(out / PAGE),
        "headline": headline(summarise(record)),
        "outcomes": Counter(task["outcome"] for task in tasks),
        "verdicts": verdicts,
        "stale_exceptions": record.run.get("stale_exceptions", []),
        "tasks": tasks,
    }
    typer.echo(dump_json(result))
