"""A choice in the terminal."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any

from rich.console import Console
from rich.text import Text

from omegadot.reports.choice import sentences as texts
from omegadot.reports.choice import tables as tables
from omegadot.reports.text.text_grid import text_grid

_WIDTH_WHEN_PIPED = 240


def print_choice(choice: Mapping[str, Any], console: Console | None = None) -> None:
    """Print, case by case, what qualifies, what does not and what would change it."""
    if console is None:
        console = Console(width=None if sys.stdout.isatty() else _WIDTH_WHEN_PIPED, highlight=False)
    console.print(Text(f"Required: {texts.requested(choice)}."))
    for case in choice["scenarios"]:
        console.print()
        for grid in (tables.ranking(choice, case), tables.refusals(case)):
            if grid.rows:
                console.print(text_grid(grid.title, grid.heads, grid.rows))
                console.print()
        for line in texts.variant_lines(case):
            console.print(Text(line))
    overall = tables.everywhere(choice)
    if overall is not None and overall.rows:
        console.print()
        console.print(text_grid(overall.title, overall.heads, overall.rows))
    console.print()
    for line in texts.notes(choice):
        console.print(Text(line, style="yellow"))
    console.print(Text(texts.GUARANTEE, style="dim"))
    for case in choice["scenarios"]:
        console.print(Text(texts.headline(case), style="bold"))
    if overall is not None:
        console.print(Text(texts.verdict_everywhere(choice), style="bold"))
