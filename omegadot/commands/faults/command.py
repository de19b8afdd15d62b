"""The arguments of ``omegadot faults``."""

from __future__ import annotations

from typing import Annotated

import typer

from omegadot.commands.options import PageFormat, on_a_terminal


def faults(
    engine: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="A built-in engine; repeatable. Default: reference."),
    ] = None,
    random: Annotated[
        int, typer.Option(metavar="N", min=1, help="Number of random systems for each fault.")
    ] = 24,
    seed: Annotated[
        int, typer.Option(metavar="INTEGER", min=0, help="Seed of the random systems.")
    ] = 0,
    output: Annotated[
        PageFormat, typer.Option("--format", help="Output format.")
    ] = PageFormat.text,
) -> None:
    """Inject known faults into sound engines and show how likely a plain check catches each.

    Exit codes: 0 every fault is caught and no sound engine is accused, 1 otherwise, 2 wrong
    usage.
    """
    from omegadot.commands.faults.faults import faults as find_faults
    from omegadot.commands.faults.print_faults import print_faults

    found = find_faults(engine or None, random=random, seed=seed, progress=on_a_terminal())
    print_faults(found, output.value)
    raise typer.Exit(0 if found.passed else 1)
