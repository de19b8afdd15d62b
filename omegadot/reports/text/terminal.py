"""The table at the end of a run: what a reader takes in within ten seconds."""

from __future__ import annotations

from rich.console import Console
from rich.measure import Measurement
from rich.table import Table
from rich.text import Text

from omegadot.reports.record.record import Record
from omegadot.reports.shipped.rows import shipped_rows
from omegadot.reports.shipped.sentence import in_one_sentence
from omegadot.reports.summary.cluster_sentences import extent, sentence
from omegadot.reports.summary.clusters import clusters_over_scenarios
from omegadot.reports.summary.engine_failure import EngineFailure
from omegadot.reports.summary.failed_gate import FailedGate
from omegadot.reports.summary.figures import Figure
from omegadot.reports.summary.headline import headline, remarks, truth, which_step
from omegadot.reports.summary.summary import Cell, Summary, counts, summarise
from omegadot.reports.text.engine_rows import (
    MOST_COLUMNS,
    engine_rows,
    explained,
    missing_lines,
    widest,
)
from omegadot.reports.text.numbers import angle, short
from omegadot.reports.text.text_grid import plain_console

_STYLES = {"pass": "green", "fail": "bold red", "declared": "yellow", "absent": "dim"}
_NOT_RUN = "magenta"
# Nothing is cut off there.
_WIDTH_WHEN_PIPED = 240
_SIGNS = {
    "pass": "every gate holds",
    "fail": "a gate fails, the first with its worst measure",
    "declared": "declared exception",
}
_WITH_NUMBERS = ("pass", "fail", "declared", "not-judged", "diverged")
# The heading of each number, and what it stands for.
_NUMBERS = (
    ("residual", "residual: of omega-dot at identical states, relative."),
    ("drift", "drift: of the angular momentum, relative."),
    ("attitude", "attitude: its error in rad."),
)


def print_summary(record: Record, console: Console | None = None) -> None:
    """Print scenario by engine: verdict and numbers, then what did not run, then the verdict.

    Each cell holds the verdict, the worst omega-dot residual, and of the worst integrator at its
    finest step the angular-momentum drift and the attitude error; or the gate that fails, with its
    worst measure. Numbers give way from the right where the terminal is too narrow for them.
    """
    console = console or plain_console(_WIDTH_WHEN_PIPED)
    summary = summarise(record)
    if len(summary.columns) > MOST_COLUMNS:
        console.print(engine_rows(summary, _signs(console), _STYLES, console.width))
        console.print(f"{_present(summary, console)}{explained(summary)}", style="dim")
    else:
        shown, table = _fitting_table(summary, console)
        if summary.columns:
            console.print(table)
            console.print(_legend(summary, shown, console), style="dim")
        for line in _extremes(summary):
            console.print(Text(line))
    for cluster in clusters_over_scenarios(record.run)[:1]:  # the largest; the page names all
        console.print(Text(f"{sentence(cluster)} {extent(cluster)}"))
    for line in missing_lines(summary.missing):
        console.print(Text(line, style=_NOT_RUN))
    if shipped := in_one_sentence(shipped_rows(record)):
        console.print(Text(shipped))
    console.print(Text("; ".join(counts(summary)) or "No run was made."))
    console.print(Text(headline(summary), style="bold"))
    for failure in summary.failures:
        _print_failure(failure, console)
    if summary.accuracy:
        console.print(Text(summary.accuracy.sentence, "yellow"))
    console.print(Text(" ".join(remarks(summary) + truth(summary))))
    if summary.untried:
        console.print(Text(summary.untried.sentence))


def _print_failure(failure: EngineFailure, console: Console) -> None:
    """Which gate where, then a line each of cause, measure, cost and what to type next."""
    console.print(Text(f"{failure.head}.", _STYLES["fail"]))
    lines = Table(box=None, show_header=False, padding=(0, 2, 0, 0))
    lines.add_column(no_wrap=True, style="bold")
    lines.add_column(overflow="fold")
    for name, text in failure.labelled:
        lines.add_row(f"  {name}", Text(text))
    console.print(lines)


def _fitting_table(summary: Summary, console: Console) -> tuple[int, Table]:
    """The table with as many numbers a cell as the console's width holds."""
    unlimited = console.options.update(width=10_000)
    for shown in range(len(_NUMBERS), 0, -1):
        table = _table(summary, shown, console)
        if Measurement.get(console, unlimited, table).maximum <= console.width:
            return shown, table
    return 0, _table(summary, 0, console)


def _table(summary: Summary, shown: int, console: Console) -> Table:
    table = Table(box=None, padding=(0, 2, 0, 0), header_style="bold")
    table.add_column("scenario", no_wrap=True, overflow="ellipsis")
    columns = []
    for column in summary.columns:
        cells = [summary.cells[scenario, column] for scenario in summary.scenarios]
        texts = _column(cells, shown, console)
        width = max((text.cell_len for text in texts), default=0)
        # Where space is short the scenarios' names give way, not the verdicts.
        table.add_column(Text(column.label), no_wrap=True, overflow="ellipsis", min_width=width)
        columns.append(texts)
    if shown == 1:  # one head for all: so it takes no room
        table.add_row("omega-dot residual", *("" for _ in columns), style="dim")
    elif shown:
        table.add_row("", *(texts[0] for texts in columns), style="dim")
    for place, scenario in enumerate(summary.scenarios, 1):
        table.add_row(Text(scenario), *(texts[place] for texts in columns))
    return table


def _column(cells: list[Cell], shown: int, console: Console) -> list[Text]:
    """An engine's cells below the headings of their numbers, aligned."""
    numbers = [_terse(cell)[:shown] for cell in cells]
    heads = [head for head, _ in _NUMBERS[:shown]] if shown > 1 else [""] * shown
    widths = [max(map(len, column)) for column in zip(heads, *numbers, strict=True)]
    aligned = [f"{head:<{width}}" for head, width in zip(heads, widths, strict=True)]
    texts = [Text(" ".join([" ", *aligned]).rstrip())]
    for cell, own in zip(cells, numbers, strict=True):
        terms = [f"{text:<{width}}" for text, width in zip(own, widths, strict=True)]
        style = _STYLES["declared"] if cell.far_off else _STYLES.get(cell.status, _NOT_RUN)
        text = Text(_mark(cell, console), style)
        if cell.failed:  # the numbers that are headed may all be of gates that hold
            text.append(_failed(cell.failed, shown, console), style)
        elif cell.status in _WITH_NUMBERS or cell.runs["pass"]:  # of the runs that were judged
            text.append(" ".join(["", *terms]).rstrip(), "default")
        texts.append(text)
    return texts


def _failed(failed: FailedGate, shown: int, console: Console) -> str:
    """The gate that fails, and its number where there is room for several."""
    number = failed.number if shown == len(_NUMBERS) else ""
    text = "".join(f" {part}" for part in (failed.gate, number) if part and shown)
    return text if _is_wide(console) else text.replace("×", "x")


def _is_wide(console: Console) -> bool:
    """Whether it can print signs that are no ASCII."""
    return console.encoding.startswith("utf")


def _signs(console: Console) -> dict[str, str]:
    """The signs of what was judged."""
    wide = _is_wide(console)
    signs = {"pass": "✓" if wide else "ok", "fail": "✗" if wide else "FAIL"}
    return signs | {"declared": "!", "absent": "-"}


def _mark(cell: Cell, console: Console) -> str:
    """A sign for what was judged, the outcome for what did not run, with how many runs passed."""
    signs = _signs(console)
    if cell.status in signs:
        return signs[cell.status]
    passed, total = cell.runs["pass"], sum(cell.runs.values())
    return cell.status + (f" {passed}/{total}" if passed else "")


def _terse(cell: Cell) -> list[str]:
    figures = (
        cell.residual,
        cell.drift.worst if cell.drift else None,
        cell.attitude.worst if cell.attitude else None,
    )
    return ["-" if f is None else short(f.value, 1).replace("not finite", "nan") for f in figures]


def _present(summary: Summary, console: Console) -> str:
    """The signs that stand in the table, each with what it stands for."""
    present = {cell.status: _mark(cell, console) for cell in summary.cells.values()}
    message = [f"{present[status]} {text}" for status, text in _SIGNS.items() if status in present]
    return "; ".join(message) + ". " if message else ""


def _legend(summary: Summary, shown: int, console: Console) -> str:
    sentences = [_present(summary, console).strip()]
    sentences += [text for _, text in _NUMBERS[:shown]]
    if shown > 1:
        names = " and ".join(name for name, _ in _NUMBERS[1:shown])
        sentences.append(f"{names}: of the worst integrator, {which_step(summary)}.")
        sentences.append("An error that the declared scheme explains passes, whatever its size.")
    return " ".join(filter(None, sentences))


def _extremes(summary: Summary) -> list[str]:
    """Per engine: its worst attitude error, and that of its best integrator on that scenario."""
    lines = []
    for column in summary.columns:
        found = widest(summary, column)
        if found is None:
            continue
        worst, best = found.worst, found.best
        span = _named(worst) if best is worst else f"{_named(best)} to {_named(worst)}"
        lines.append(
            f"{column.label}: attitude error {span} on {worst.scenario}, {which_step(summary)}."
        )
    return lines


def _named(figure: Figure) -> str:
    source = f" ({figure.integrator})" if figure.integrator else ""
    return f"{angle(figure.value)}{source}"
