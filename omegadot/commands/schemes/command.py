"""The arguments of ``omegadot schemes``."""

from __future__ import annotations

from typing import Annotated

import typer

from omegadot.commands.options import (
    Adapters,
    PageFormat,
    PageOutput,
    Texts,
    exit_code,
    on_a_terminal,
    option,
)


def schemes(
    engines: Annotated[
        Texts,
        option(
            "NAME[:INTEGRATOR]",
            "An engine; repeatable. Default: all but exact and reference.",
            "--engine",
        ),
    ] = None,
    adapters: Adapters = None,
    python: Annotated[
        Texts,
        option(
            "NAME=PATH",
            "A Python interpreter for one engine: another version of it, installed there with "
            "NumPy and SciPy; repeatable.",
        ),
    ] = None,
    output: PageOutput = PageFormat.text,
) -> None:
    """Identify the scheme of every integrator by its steps, with its orders and defects.

    Exit codes: 0 all is as declared, 1 something is not, 2 wrong usage, 3 an engine crashed,
    timed out or could not be started.
    """
    from omegadot.commands.other_python import interpreters
    from omegadot.commands.schemes.print_schemes import print_schemes
    from omegadot.commands.schemes.schemes import schemes as study_schemes

    found = study_schemes(
        engines or (),
        adapters=adapters or (),
        pythons=interpreters(python or []),
        progress=on_a_terminal(),
    )
    print_schemes(found, output.value)
    raise typer.Exit(exit_code(found.passed, found.answered))
