"""The words of ``omegadot faults``."""

from __future__ import annotations

from typing import Annotated

import typer

from omegadot.commands.options import PageFormat


def faults(
    engine: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME", help="A built-in engine; repeat for more. Default: reference."
        ),
    ] = None,
    bodies: Annotated[
        int, typer.Option(metavar="N", min=1, help="Random bodies for each fault.")
    ] = 5,
    seed: Annotated[int, typer.Option(min=0, help="For the random bodies.")] = 0,
    output: Annotated[
        PageFormat, typer.Option("--format", help="What to print.")
    ] = PageFormat.text,
) -> None:
    """Break sound engines in known ways and show which gate catches what, and how often.

    Exit codes: 0 every fault is caught on every body and nothing sound is accused, 1 not so,
    2 wrong usage.
    """
    from omegadot.commands.faults.faults import print_faults

    raise typer.Exit(print_faults(engine or [], bodies, seed, output.value))
