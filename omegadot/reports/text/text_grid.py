"""A titled table in the terminal, without rules."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from rich.table import Table
from rich.text import Text


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
