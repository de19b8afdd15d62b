"""The arguments of ``omegadot compare``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from omegadot.commands.options import PageFormat


def compare(
    first: Annotated[
        Path, typer.Argument(metavar="EARLIER", help="The folder of the earlier run.")
    ],
    second: Annotated[Path, typer.Argument(metavar="LATER", help="The folder of the later run.")],
    output: Annotated[
        PageFormat, typer.Option("--format", help="Output format.")
    ] = PageFormat.text,
) -> None:
    """Compare two stored runs: what got better, got worse, appeared or vanished.

    Exit codes: 0 nothing got worse, 1 something did, 2 wrong usage or input.
    """
    from omegadot.commands.compare.compare import compare_folders

    message, code = compare_folders(first, second, output.value)
    typer.echo(message)
    raise typer.Exit(code)
