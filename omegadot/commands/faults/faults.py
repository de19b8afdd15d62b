"""``omegadot faults``: which gate catches which fault, how often, and what published checks do."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import typer

from omegadot.adapters.registry import BUILT_IN
from omegadot.commands.faults.matrix import EngineMatrix, engine_matrix, quiet_engines
from omegadot.commands.faults.matrix_text import (
    HEADS,
    Settings,
    line_of,
    markdown,
    plain,
    summary_of,
)
from omegadot.commands.faults.prepared import Pool
from omegadot.harness.usage import UsageError, nearest

ENGINES = tuple(name for name in BUILT_IN if name != "exact")  # the truth cannot be wrong
WIDTH_WHEN_PIPED = 200


def print_faults(engines: Sequence[str], bodies: int, seed: int, form: str) -> int:
    """Work out the matrix, print it in `form` ("text", "json" or "markdown"), return the exit code.

    0: every fault is caught on every body, and nothing sound is accused.  1: not so.  Raises
    UsageError for an engine that is unknown or not installed.
    """
    settings = Settings(tuple(dict.fromkeys(engines)) or ("reference",), bodies, seed)
    for name in settings.engines:
        if name not in ENGINES:
            raise UsageError(f"--engine {name}: faults go over {nearest(name, ENGINES)}.")
    pool, matrices = Pool(seed), []
    with _status(), quiet_engines():
        for name in settings.engines:
            try:
                matrices.append(engine_matrix(name, pool, bodies))
            except ImportError as error:
                raise UsageError(
                    f"--engine {name}: not installed ({error}); install it."
                ) from error
    if form == "json":
        typer.echo(json.dumps(plain(settings, matrices), indent=2))
    elif form == "markdown":
        typer.echo(markdown(settings, matrices), nl=False)
    else:
        _print_text(matrices)
    return exit_code(matrices)


def exit_code(matrices: Sequence[EngineMatrix]) -> int:
    """1 where a fault goes unseen on some body or a sound engine is accused on one."""
    unseen = any(row.judged and row.any < 1.0 for matrix in matrices for row in matrix.rows)
    return 1 if unseen or any(matrix.accused for matrix in matrices) else 0


@contextmanager
def _status() -> Iterator[None]:
    if not sys.stderr.isatty():
        yield
        return
    from rich.console import Console

    with Console(stderr=True).status("putting wrong engines through the gates"):
        yield


def _print_text(matrices: Sequence[EngineMatrix]) -> None:
    from rich.console import Console
    from rich.table import Table

    console = Console(width=None if sys.stdout.isatty() else WIDTH_WHEN_PIPED, highlight=False)
    for matrix in matrices:
        title = f"Per cent of the bodies on which each fault over {matrix.engine} is caught"
        table = Table(title=title, title_justify="left", title_style="bold", box=None)
        for number, head in enumerate(HEADS):
            table.add_column(head, justify="right" if number else "left", overflow="fold")
        for row in matrix.rows:
            table.add_row(*line_of(row))
        console.print(table)
        for line in summary_of(matrix):
            console.print(line, markup=False)
        console.print()
