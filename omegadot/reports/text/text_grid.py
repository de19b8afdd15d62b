"""A titled table, and how the terminal shows it: without rules."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from rich.console import Console
from rich.table import Table
from rich.text import Text


class Grid(NamedTuple):
    """A plain table; every row has as many texts as there are heads."""

    title: str
    heads: Sequence[str]
    rows: Sequence[Sequence[str]]


def text_grid(title: str, heads: Sequence[str], rows: Iterable[Sequence[str]]) -> Table:
    """Heads over rows; whatever a cell holds stays text, and is folded rather than cut."""
    grid = Table(
        title=title,
        title_justify="left",
        title_style="bold",
        box=None,
        padding=(0, 2, 0, 0),
        header_style="bold",
    )
    for head in heads:
        grid.add_column(head, overflow="fold")
    for row in rows:
        grid.add_row(*map(Text, row))
    return grid


def plain_console(width_when_piped: int) -> Console:
    """A console without highlights: piped output has no width of its own."""
    width = None if sys.stdout.isatty() else width_when_piped
    return Console(width=width, highlight=False, emoji=False)
