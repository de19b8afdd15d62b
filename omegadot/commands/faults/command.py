"""The arguments of ``omegadot faults``."""

from __future__ import annotations

from typing import Annotated

import typer

from omegadot.commands.options import PageFormat


def faults(
    engine: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="A built-in engine; repeatable. Default: reference."),
    ] = None,
    bodies: Annotated[
        int, typer.Option(metavar="N", min=1, help="Number of random bodies for each fault.")
    ] = 5,
    seed: Annotated[
        int, typer.Option(metavar="INTEGER", min=0, help="Seed of the random bodies.")
    ] = 0,
    output: Annotated[
        PageFormat, typer.Option("--format", help="Output format.")
    ] = PageFormat.text,
) -> None:
    """Inject known faults into sound engines and show which gate catches each, and how often.

    Exit codes: 0 every fault is caught on every body and no sound engine is accused, 1
    otherwise, 2 wrong usage.
    """
    from omegadot.commands.faults.faults import print_faults

    raise typer.Exit(print_faults(engine or [], bodies, seed, output.value))
