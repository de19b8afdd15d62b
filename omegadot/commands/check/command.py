"""The arguments of ``omegadot check``."""

from __future__ import annotations

from typing import Annotated

import typer

from omegadot.commands import options
from omegadot.commands.options import Text, Texts, option


def check(
    engine: Annotated[
        Text,
        typer.Argument(
            metavar="ADAPTER",
            help="An engine's name, NAME:INTEGRATOR, FILE.py, FILE.py:Class, module:Class, or a "
            "program's command.",
        ),
    ] = None,
    adapter: Annotated[
        Text, option("FILE.py:CLASS", "The engine, in place of ADAPTER.", "--adapter")
    ] = None,
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

    Exit codes: 0 every check holds, 1 one fails, 2 wrong usage or input, 3 the engine crashed,
    timed out or could not be started, or all checks but those of its model were skipped. Ctrl-C
    prints what was found until then.
    """
    arguments = options.given({k: v for k, v in locals().items() if k != "verbose"})
    arguments["engine"] = _only_one(arguments.get("engine"), arguments.pop("adapter", None))
    from omegadot.commands.check.check import check as check_engine
    from omegadot.commands.check.check_result import CheckInterrupted
    from omegadot.commands.check.print_checks import exit_code, print_checks, print_json

    try:
        found = check_engine(**arguments, program=options.program())
    except CheckInterrupted as interrupted:
        found = interrupted.result
    if output is options.Format.json:
        print_json(found)
    else:
        print_checks(found, verbose)
    raise typer.Exit(exit_code(found))


def _only_one(engine: str | None, adapter: str | None) -> str:
    """The engine, given one way or the other. Raises UsageError."""
    from omegadot.harness.usage import UsageError

    if engine is not None and adapter is not None:
        raise UsageError(
            f"--adapter {adapter}: {engine} is given too, and one engine is checked; write "
            f"omegadot check {adapter}."
        )
    found = engine if engine is not None else adapter
    if found is None:
        raise UsageError(
            "Missing argument 'ADAPTER'; give an engine, as omegadot check mujoco or omegadot "
            "check FILE.py:Class."
        )
    return found
