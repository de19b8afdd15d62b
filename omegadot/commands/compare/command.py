"""The words of ``omegadot compare``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from omegadot.commands.options import PageFormat


def compare(
    first: Annotated[Path, typer.Argument(metavar="RUN", help="The folder of the earlier run.")],
    second: Annotated[Path, typer.Argument(metavar="RUN", help="The folder of the later run.")],
    output: Annotated[
        PageFormat, typer.Option("--format", help="What to print.")
    ] = PageFormat.text,
) -> None:
    """Say what got better, worse, appeared and vanished from one stored run to another.

    Exit codes: 0 nothing got worse, 1 something did, 2 wrong usage or input.
    """
    from omegadot.commands.compare.compare import compare_folders

    message, code = compare_folders(first, second, output.value)
    typer.echo(message)
    raise typer.Exit(code)
