"""A choice in the terminal."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rich.console import Console
from rich.text import Text

from omegadot.reports.choice import sentences, tables
from omegadot.reports.text.text_grid import plain_console, text_grid


def print_choice(choice: Mapping[str, Any], console: Console | None = None) -> None:
    """Print, case by case, what qualifies, what does not and what would change it."""
    console = console or plain_console(240)
    console.print(Text(f"Required: {sentences.requested(choice)}."))
    for case in choice["scenarios"]:
        console.print()
        for grid in (tables.ranking(choice, case), tables.refusals(case)):
            if grid.rows:
                console.print(text_grid(*grid))
                console.print()
        for line in sentences.variant_lines(case):
            console.print(Text(line))
    overall = tables.everywhere(choice)
    if overall is not None and overall.rows:
        console.print()
        console.print(text_grid(*overall))
    console.print()
    for line in sentences.notes(choice):
        console.print(Text(line, style="yellow"))
    console.print(Text(sentences.GUARANTEE, style="dim"))
    for case in choice["scenarios"]:
        console.print(Text(sentences.headline(case), style="bold"))
    if overall is not None:
        console.print(Text(sentences.verdict_everywhere(choice), style="bold"))
