"""The arguments of ``omegadot check``."""

from __future__ import annotations

from typing import Annotated

import typer

from omegadot.commands import options
from omegadot.commands.options import Text, Texts, option


def check(
    engine: Annotated[
        str,
        typer.Argument(
            metavar="ADAPTER",
            help="An engine's name, FILE.py, FILE.py:Class, module:Class, or a program's command.",
        ),
    ],
    scenarios: Annotated[
        Texts,
        option(
            "NAME",
            "A built-in name, random-SEED-INDEX or a path; repeatable. Default: all built-in "
            "scenarios, and random systems.",
            "--scenario",
        ),
    ] = None,
    random: Annotated[
        int | None,
        option("N", "Random systems. Default: 24, or none where a scenario is given.", min=0),
    ] = None,
    seed: Annotated[int, option("INTEGER", "Seed of the random systems.", min=0)] = 0,
    integrators: options.Integrators = None,
    via: options.Ways = None,
    exceptions: options.Exceptions = None,
    baseline: Annotated[Text, option("DIR", "Compare with the values stored in DIR.")] = None,
    update_baseline: Annotated[
        bool,
        typer.Option(
            "--update-baseline", help="Store the values in --baseline DIR instead of comparing."
        ),
    ] = False,
    timeout: options.Timeout = 60.0,
    shrink: Annotated[
        bool,
        typer.Option(
            "--shrink/--no-shrink",
            help="Look for the simplest system on which a gate fails, where one does.",
        ),
    ] = True,
    verbose: Annotated[
        bool,
        typer.Option("--verbose", help="List every check that fails, not the first of each cause."),
    ] = False,
    output: options.Output = options.Format.text,
) -> None:
    """Check one engine, built in or your own, at every gate.

    Exit codes: 0 every check holds, 1 one fails or all but those of the model were skipped, 2 wrong
    usage or input, 3 the engine crashed, timed out or could not be started.
    """
    arguments = options.given({k: v for k, v in locals().items() if k != "verbose"})
    from omegadot.commands.check.check import check as check_engine
    from omegadot.commands.check.print_checks import print_checks, print_json

    found = check_engine(**arguments)
    if output is options.Format.json:
        print_json(found)
    else:
        print_checks(found, verbose)
    raise typer.Exit(options.exit_code(found.passed, found.answered))
