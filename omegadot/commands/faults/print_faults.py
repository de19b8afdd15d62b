"""What ``omegadot faults`` prints."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence

import typer
from rich.console import Console
from rich.table import Table

from omegadot.commands.faults.faults import FaultsResult
from omegadot.commands.faults.matrix import EngineMatrix
from omegadot.commands.faults.matrix_text import HEADS, line_of, markdown, plain, summary_of

WIDTH_WHEN_PIPED = 200


def print_faults(found: FaultsResult, form: str) -> None:
    """As "text", "json" or "markdown"."""
    if form == "json":
        typer.echo(json.dumps(plain(found.settings, found.matrices), indent=2))
    elif form == "markdown":
        typer.echo(markdown(found.settings, found.matrices), nl=False)
    else:
        _print_text(found.matrices)


def _print_text(matrices: Sequence[EngineMatrix]) -> None:
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
