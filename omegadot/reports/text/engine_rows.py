"""Many engines in the terminal: a row each, where a column each would fit on none.

A row has how many scenarios came to what, and of the worst one the numbers.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

from rich.console import JustifyMethod
from rich.table import Table
from rich.text import Text

from omegadot.reports.summary.figures import Range, size
from omegadot.reports.summary.headline import which_step
from omegadot.reports.summary.summary import STATUSES, Column, Missing, Summary
from omegadot.reports.text.numbers import degrees, first, listed, short, times

MOST_COLUMNS = 8  # engines side by side, with their verdicts alone, in the narrowest usual terminal
LEAST_TEXT = 10  # characters: less of a column says nothing


def engine_rows(
    summary: Summary, signs: Mapping[str, str], styles: Mapping[str, str], width: int
) -> Table:
    """The table, an engine a row, `width` characters wide.

    signs, styles: of a status; one that has no sign is written out.
    """
    present = _statuses(summary)
    heads = [Text(signs.get(status, status), styles.get(status, "")) for status in present]
    rows = []
    for column in summary.columns:
        counts = Counter(summary.cells[scenario, column].status for scenario in summary.scenarios)
        numbers = [
            Text(str(counts[status] or ""), styles.get(status, "") if status != "pass" else "")
            for status in present
        ]
        figures = map(Text, (_residual(summary, column), *_attitude(summary, column)))
        rows.append([Text(column.label), *numbers, *figures])
    headings = [Text("engine"), *heads, Text("omega-dot"), Text("attitude in deg"), Text("on")]
    every = [headings, *rows]
    widths = [2 + max(cell.cell_len for cell in cells) for cells in zip(*every, strict=True)]
    shown = len(widths)
    while sum(widths[: shown - 1]) + LEAST_TEXT > width and shown > 1 + len(present):
        shown -= 1  # what is to the right gives way
    room = width - sum(widths[: shown - 1])
    for cells in every:
        cells[shown - 1].truncate(room - 2, overflow="ellipsis")
    table = Table(box=None, padding=(0, 2, 0, 0), header_style="bold")
    for place, heading in enumerate(headings[:shown]):
        justify: JustifyMethod = "right" if 0 < place <= len(present) else "left"
        table.add_column(heading, justify=justify, no_wrap=True)
    for cells in rows:
        table.add_row(*cells[:shown])
    return table


def explained(summary: Summary) -> str:
    """What the columns are."""
    return (
        "Numbers of scenarios by their worst run. omega-dot: the largest residual at identical "
        f"states, relative. attitude: the error, {which_step(summary)}, of the best and the "
        "worst integrator on the scenario where it is largest; an error that the declared scheme "
        "explains passes, whatever its size."
    )


def widest(summary: Summary, column: Column) -> Range | None:
    """The attitude errors of an engine on the scenario where the worst of them is largest."""
    cells = [summary.cells[scenario, column] for scenario in summary.scenarios]
    ranges = [cell.attitude for cell in cells if cell.attitude is not None]
    return max(ranges, key=lambda r: size(r.worst), default=None)


def missing_lines(missing: Sequence[Missing]) -> list[str]:
    """A line for each reason for which runs gave no verdict, of all engines that have it.

    Reasons of several engines are the same if they are so but for the engine's name.
    """
    groups: dict[tuple[object, ...], list[Missing]] = {}
    for item in missing:
        reason = item.reason.replace(item.engine, "the engine")
        groups.setdefault((item.status, reason, item.scenarios, item.runs), []).append(item)
    return [_missing_line(group) for group in groups.values()]


def _missing_line(group: Sequence[Missing]) -> str:
    one = group[0]
    line = f"{listed([item.engine for item in group])}: {one.status}"
    several = len(group) > 1
    if one.runs:
        each = " each" * several
        line += f", {times(one.runs, 'run')}{each} on {first(one.scenarios, 4)}"
    reason = one.reason.replace(one.engine, "the engine") if several else one.reason
    return line + (f": {reason}" if reason else "")


def _statuses(summary: Summary) -> list[str]:
    """Those that occur, the sound ones in front."""
    found: Iterable[str] = {cell.status for cell in summary.cells.values()}
    return sorted(found, key=STATUSES[::-1].index)


def _residual(summary: Summary, column: Column) -> str:
    cells = [summary.cells[scenario, column].residual for scenario in summary.scenarios]
    found = [figure for figure in cells if figure is not None]
    if not found:
        return "-"
    worst = max(found, key=size)
    return f"{short(worst.value, 1)} on {worst.scenario}"


def _attitude(summary: Summary, column: Column) -> tuple[str, str]:
    """The errors of the best and of the worst integrator; these, and the scenario."""
    found = widest(summary, column)
    if found is None:
        return "-", ""
    ends = {figure.integrator: degrees(figure.value) for figure in (found.best, found.worst)}
    names = " to ".join(name for name in ends if name)
    return " to ".join(ends.values()), ": ".join(filter(None, (found.worst.scenario, names)))
