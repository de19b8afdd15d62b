"""``omegadot schemes``: which scheme each integrator steps, and how its errors shrink."""

from __future__ import annotations

import json
import sys
import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

import typer

from omegadot.commands.other_python import interpreters, worker_command
from omegadot.commands.schemes.markdown import markdown_of
from omegadot.commands.schemes.table import remarks_of, tables_of
from omegadot.diagnosis.scheme_study.record import Record, record_of
from omegadot.diagnosis.scheme_study.study import EngineStudy, study_engine
from omegadot.harness.arguments import engine_choices
from omegadot.harness.plan import EngineChoice
from omegadot.workers.harness_end.process import WorkerProcess

TIMEOUT = 60.0  # s, for one request to an engine
NOT_STEPPED = "exact"  # the truth that the others are held against
ITSELF = "reference"  # it would be held against itself
WIDTH_WHEN_PIPED = 240
BROKEN = ("crashed", "timeout", "raised")


def print_schemes(
    engines: Sequence[str], adapters: Sequence[str], pythons: Sequence[str], form: str
) -> int:
    """Study the engines, print in `form` ("text", "json" or "markdown"), return the exit code.

    Without a choice of engines the exact solution and the reference are left out. Raises
    UsageError.
    """
    choices = [
        choice
        for choice in engine_choices(engines, adapters)
        if choice.required or choice.name not in (NOT_STEPPED, ITSELF)
    ]
    chosen = interpreters(pythons, [choice.name for choice in choices])
    with _status():
        record = record_of(study_all(choices, chosen))
    if form == "json":
        typer.echo(json.dumps(record, indent=2))
    elif form == "markdown":
        typer.echo(markdown_of(record), nl=False)
    else:
        _print_text(record)
    return exit_code(record, choices)


def study_all(choices: Sequence[EngineChoice], pythons: dict[str, str]) -> list[EngineStudy]:
    """Every engine at the same time, each with a worker; Ctrl-C ends them at once."""
    workers = []
    for choice in choices:
        command = worker_command(pythons[choice.name]) if choice.name in pythons else None
        workers.append(WorkerProcess(choice.target, "physics", TIMEOUT, command))
    stopping = threading.Event()
    with ThreadPoolExecutor(max(1, len(choices))) as threads:
        futures = [
            threads.submit(study_engine, choice, worker, stopping)
            for choice, worker in zip(choices, workers, strict=True)
        ]
        try:
            return [future.result() for future in futures]
        except BaseException:
            stopping.set()
            for worker in workers:
                worker.stop()
            raise


@contextmanager
def _status() -> Iterator[None]:
    """State that it is at work on a terminal, nothing where standard error is piped."""
    if not sys.stderr.isatty():
        yield
        return
    from rich.console import Console

    with Console(stderr=True).status("stepping the reference's schemes next to the engines"):
        yield


def exit_code(record: Record, choices: Sequence[EngineChoice]) -> int:
    """0 all is as declared, 1 something is not, 3 an engine failed to answer or to start."""
    required = {choice.name for choice in choices if choice.required}
    for engine in record["engines"]:
        absent = engine["outcome"] == "not-installed"
        if engine["outcome"] != "ok" and not (absent and engine["name"] not in required):
            return 3
    integrators = [i for engine in record["engines"] for i in engine["integrators"]]
    if any(p["outcome"] in BROKEN for i in integrators for p in i["probes"].values()):
        return 3
    return 1 if any(integrator["departures"] for integrator in integrators) else 0


def _print_text(record: Record) -> None:
    from rich.console import Console
    from rich.text import Text

    from omegadot.reports.text.text_grid import text_grid

    console = Console(width=None if sys.stdout.isatty() else WIDTH_WHEN_PIPED, highlight=False)
    tables = [table for table in tables_of(record) if table.rows]
    for table in tables:
        console.print(text_grid(table.title, table.heads, table.rows))
        console.print()
    for line in remarks_of(record):
        console.print(Text(line, style="yellow"))
