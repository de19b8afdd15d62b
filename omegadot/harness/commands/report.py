"""The words of ``omegadot report``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def report(
    folder: Annotated[Path, typer.Argument(metavar="RUN", help="The folder of a run.")],
) -> None:
    """Draw the page of a stored run again."""
    from omegadot.harness.command_report import redraw

    typer.echo(redraw(folder))
