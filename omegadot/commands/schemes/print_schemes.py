"""What ``omegadot schemes`` prints, and how it exits."""

from __future__ import annotations

import json
import sys

import typer
from rich.console import Console
from rich.text import Text

from omegadot.commands.schemes.markdown import markdown_of
from omegadot.commands.schemes.schemes import SchemesResult
from omegadot.commands.schemes.table import remarks_of, tables_of
from omegadot.reports.text.text_grid import text_grid

WIDTH_WHEN_PIPED = 240


def exit_code(found: SchemesResult) -> int:
    """0 all is as declared, 1 something is not, 3 an engine failed to answer or to start."""
    if not found.answered:
        return 3
    return 0 if found.passed else 1


def print_schemes(found: SchemesResult, form: str) -> None:
    """As "text", "json" or "markdown"."""
    if form == "json":
        typer.echo(json.dumps(found.record, indent=2))
    elif form == "markdown":
        typer.echo(markdown_of(found.record), nl=False)
    else:
        _print_text(found)


def _print_text(found: SchemesResult) -> None:
    console = Console(width=None if sys.stdout.isatty() else WIDTH_WHEN_PIPED, highlight=False)
    for table in tables_of(found.record):
        if table.rows:
            console.print(text_grid(table.title, table.heads, table.rows))
            console.print()
    for line in remarks_of(found.record):
        console.print(Text(line, style="yellow"))
