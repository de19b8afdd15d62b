"""The words of ``omegadot schemes``."""

from __future__ import annotations

from typing import Annotated

import typer

from omegadot.commands.options import PageFormat


def schemes(
    engine: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME[:INTEGRATOR]",
            help="An engine; repeat for more. Default: all but exact and reference.",
        ),
    ] = None,
    adapter: Annotated[
        list[str] | None,
        typer.Option(metavar="FILE.py:CLASS", help="An engine of your own; repeatable."),
    ] = None,
    python: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=PATH",
            help="The interpreter that an engine runs under, so that an other version of it in its "
            "own environment, beside NumPy and SciPy, can be studied; repeatable.",
        ),
    ] = None,
    output: Annotated[
        PageFormat, typer.Option("--format", help="What to print.")
    ] = PageFormat.text,
) -> None:
    """Name the scheme of every integrator, from its steps alone, with its orders and defects.

    Exit codes: 0 all is as declared, 1 something is not, 2 wrong usage, 3 an engine crashed, hung
    or could not be started.
    """
    from omegadot.commands.schemes.schemes import print_schemes

    raise typer.Exit(print_schemes(engine or [], adapter or [], python or [], output.value))
