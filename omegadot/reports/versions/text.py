"""The sheet of several versions as Markdown, and in the terminal."""

from __future__ import annotations

from collections.abc import Sequence

from rich.table import Table
from rich.text import Text

from omegadot.reports.text.text_grid import plain_console, text_grid
from omegadot.reports.versions.sheet import Part, Sheet


def markdown_of(sheet: Sheet) -> str:
    """The sheet as Markdown, fit for a page or a pull request."""
    lines = [f"# {sheet.title}", "", *sheet.remarks, ""]
    lines += _listed("## Did not run", sheet.absent)
    lines += _listed("## Not as declared, or failed queries", sheet.wrong)
    for part in sheet.parts:
        lines += _listed(f"## {part.head}", part.lines)
    for table in sheet.tables:
        rule = ("---",) * len(table.heads)
        rows = [_row(row) for row in (table.heads, rule, *table.rows)]
        lines += [f"## {table.title}", "", *rows, ""]
    return "\n".join(lines).rstrip() + "\n"


def _listed(head: str, lines: list[tuple[str, str]]) -> list[str]:
    if not lines:
        return []
    items = [f"- **{what}**: {text}" if what else f"- {text}" for what, text in lines]
    return [head, "", *items, ""]


def _row(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def print_sheet(sheet: Sheet) -> None:
    """The sheet in the terminal."""
    console = plain_console(160)
    console.print(Text(sheet.title, style="bold"))
    for line in sheet.remarks:
        console.print(Text(line, style="dim"))
    parts = [Part("did not run", sheet.absent)] if sheet.absent else []
    parts += sheet.parts
    if sheet.wrong:
        parts.append(Part("not as declared, or failed queries", sheet.wrong))
    for part in parts:
        console.print()
        console.print(Text(part.head, style="bold"))
        console.print(_grid(part.lines))
    for table in sheet.tables:
        console.print()
        console.print(text_grid(*table))


def _grid(lines: list[tuple[str, str]]) -> Table:
    grid = Table.grid(padding=(0, 2))
    grid.add_column(no_wrap=True)
    grid.add_column(overflow="fold")
    for what, text in lines:
        grid.add_row(Text(f"  {what}"), Text(text))
    return grid
