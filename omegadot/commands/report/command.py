"""The arguments of ``omegadot report``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def report(
    runs: Annotated[
        list[Path], typer.Argument(metavar="RUN [RUN]", help="The folder of one run, or of two.")
    ],
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="File for the page. Default: report.html in the run's folder, or two-runs.html.",
        ),
    ] = None,
    figures: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Folder for the charts as SVG and PNG."),
    ] = None,
    markdown: Annotated[
        bool, typer.Option("--markdown", help="Print a summary in Markdown, for a pull request.")
    ] = False,
) -> None:
    """Draw the report of a stored run again, or of two runs side by side."""
    from omegadot.commands.report.print_report import printed

    typer.echo(printed(runs, out, figures, markdown))
