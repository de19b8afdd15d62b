"""The arguments of ``omegadot schemes``."""

from __future__ import annotations

from typing import Annotated

import typer

from omegadot.commands.options import PageFormat, on_a_terminal


def schemes(
    engine: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME[:INTEGRATOR]",
            help="An engine; repeatable. Default: all but exact and reference.",
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
            help="A Python interpreter for one engine: another version of it, installed there with "
            "NumPy and SciPy; repeatable.",
        ),
    ] = None,
    output: Annotated[
        PageFormat, typer.Option("--format", help="Output format.")
    ] = PageFormat.text,
) -> None:
    """Identify the scheme of every integrator by its steps, with its orders and defects.

    Exit codes: 0 all is as declared, 1 something is not, 2 wrong usage, 3 an engine crashed,
    timed out or could not be started.
    """
    from omegadot.commands.other_python import interpreters
    from omegadot.commands.schemes.print_schemes import exit_code, print_schemes
    from omegadot.commands.schemes.schemes import schemes as study_schemes

    found = study_schemes(
        engine or [],
        adapters=adapter or [],
        pythons=interpreters(python or []),
        progress=on_a_terminal(),
    )
    print_schemes(found, output.value)
    raise typer.Exit(exit_code(found))
