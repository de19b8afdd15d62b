"""The words of ``omegadot report``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def report(
    runs: Annotated[
        list[Path], typer.Argument(metavar="RUN [RUN]", help="The folder of a run, or of two.")
    ],
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Where the page goes. Default: into the run's folder; of two runs, two-runs.html.",
        ),
    ] = None,
    figures: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Write the charts there, as SVG and PNG, for papers."),
    ] = None,
    markdown: Annotated[
        bool, typer.Option("--markdown", help="Print a summary for a pull request's comment.")
    ] = False,
) -> None:
    """Draw the page of a stored run again, or two runs side by side on one page."""
    from omegadot.commands.report.report import report_of

    typer.echo(report_of(runs, out, figures, markdown))
