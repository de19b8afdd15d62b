"""The arguments of ``omegadot schemes``."""

from __future__ import annotations

from typing import Annotated

import typer

from omegadot.commands import options
from omegadot.commands.options import Texts, option


def schemes(
    engines: Annotated[
        Texts,
        option(
            "NAME[:INTEGRATOR]",
            "An engine; repeatable. Default: all but exact and reference.",
            "--engine",
        ),
    ] = None,
    adapters: options.Adapters = None,
    python: Annotated[
        Texts,
        option(
            "NAME=PATH",
            "A Python interpreter for one engine: another version of it, installed there with "
            "NumPy and SciPy; repeatable.",
        ),
    ] = None,
    output: options.PageOutput = options.PageFormat.text,
) -> None:
    """Identify the scheme of every integrator by its steps, with its orders and defects.

    Exit codes: 0 all is as declared, 1 something is not, 2 wrong usage, 3 an engine crashed,
    timed out or could not be started.
    """
    arguments = options.given(locals())
    from omegadot.commands.other_python import interpreters
    from omegadot.commands.schemes.print_schemes import print_schemes
    from omegadot.commands.schemes.schemes import schemes as study_schemes

    pythons = interpreters(arguments.pop("python", []))
    found = study_schemes(**arguments, pythons=pythons)
    print_schemes(found, output.value)
    raise typer.Exit(options.exit_code(found.passed, found.answered))
