"""A choice in the terminal."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from omegadot.reports import choice as words
from omegadot.reports import choice_tables as tables

_WIDTH_WHEN_PIPED = 240


def _grid(grid: tables.Grid) -> Table:
    table = Table(
        title=grid.title,
        title_justify="left",
        title_style="bold",
        box=None,
        padding=(0, 2, 0, 0),
        header_style="bold",
    )
    for head in grid.heads:
        table.add_column(head, overflow="fold")
    for row in grid.rows:
        table.add_row(*map(Text, row))
    return table


def print_choice(choice: Mapping[str, Any], console: Console | None = None) -> None:
    """Print, case by case, who qualifies, who does not and what would change it."""
    if console is None:
        console = Console(width=None if sys.stdout.isatty() else _WIDTH_WHEN_PIPED, highlight=False)
    console.print(Text(f"Asked: {words.asked(choice)}."))
    for case in choice["scenarios"]:
        console.print()
        for grid in (tables.ranking(choice, case), tables.refusals(case)):
            if grid.rows:
                console.print(_grid(grid))
                console.print()
        for line in words.variant_lines(case):
            console.print(Text(line))
    overall = tables.everywhere(choice)
    if overall is not None and overall.rows:
        console.print()
        console.print(_grid(overall))
    console.print()
    for line in words.notes(choice):
        console.print(Text(line, style="yellow"))
    console.print(Text(words.GUARANTEE, style="dim"))
    for case in choice["scenarios"]:
        console.print(Text(words.headline(case), style="bold"))
    if overall is not None:
        console.print(Text(words.verdict_everywhere(choice), style="bold"))
