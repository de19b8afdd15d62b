"""The arguments of ``omegadot report``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from omegadot.commands.options import option
from omegadot.commands.streams import on_one_line


def report(
    runs: Annotated[
        list[Path], typer.Argument(metavar="RUN [RUN]", help="The folder of one run, or of two.")
    ],
    out: Annotated[
        Path | None,
        option(
            "FILE", "File for the page. Default: report.html in the run's folder, or two-runs.html."
        ),
    ] = None,
    figures: Annotated[Path | None, option("DIR", "Folder for the charts as SVG and PNG.")] = None,
    markdown: Annotated[
        bool, typer.Option("--markdown", help="Print a summary in Markdown, for a pull request.")
    ] = False,
) -> None:
    """Draw the report of a stored run again, or of two runs side by side.

    Exit codes: 0 drawn, whatever the verdicts in it, 2 wrong usage or input, 3 the system failed,
    as on a full disk.
    """
    typer.echo(printed(runs, out, figures, markdown))


def printed(runs: list[Path], out: Path | None, figures: Path | None, markdown: bool) -> str:
    """The files that were written, or a summary in Markdown. Raises RecordError and UsageError."""
    from omegadot.commands.compare.compare import compare
    from omegadot.commands.report.report import report as draw
    from omegadot.harness.usage import UsageError
    from omegadot.reports.run_record import read_record
    from omegadot.reports.two_runs.text import as_markdown

    if len(runs) > 2:
        raise UsageError(f"{len(runs)} runs are given; give one, or two to hold side by side.")
    if markdown and (out is not None or figures is not None):
        raise UsageError("--markdown prints and writes no file; leave out --out and --figures.")
    if len(runs) == 2 and figures is not None:
        raise UsageError("--figures draws one run; give one run alone.")
    if markdown:
        one = len(runs) == 1
        return read_record(runs[0]).markdown() if one else as_markdown(compare(*runs)).rstrip("\n")
    if figures is None:
        return on_one_line(draw(*runs, out=out))
    written = [draw(runs[0], out=out)] if out is not None else []
    return "\n".join(map(on_one_line, [*written, *read_record(runs[0]).figures(figures)]))
