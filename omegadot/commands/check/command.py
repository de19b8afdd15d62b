"""The words of ``omegadot check``."""

from __future__ import annotations

from typing import Annotated

import typer

from omegadot.commands.options import Format


def check(
    adapter: Annotated[
        str,
        typer.Argument(metavar="ADAPTER", help="An engine's name, FILE.py:Class or module:Class."),
    ],
    scenario: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="A built-in's name or a path; repeatable. Default: all."),
    ] = None,
    integrator: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="Repeatable. Default: all.")
    ] = None,
    exceptions: Annotated[
        list[str] | None,
        typer.Option(metavar="FILE", help="Known failures, declared in TOML; repeatable."),
    ] = None,
    baseline: Annotated[
        str | None, typer.Option(metavar="DIR", help="Compare with the figures stored there.")
    ] = None,
    update_baseline: Annotated[
        bool, typer.Option("--update-baseline", help="Store the figures instead.")
    ] = False,
    timeout: Annotated[
        float, typer.Option(metavar="S", min=0.1, help="Limit for one request to an engine.")
    ] = 60.0,
    output: Annotated[Format, typer.Option("--format", help="What to print.")] = Format.text,
) -> None:
    """Put one engine, built in or your own, through every check.

    Exit codes: 0 every check holds, 1 one fails or all were skipped, 2 wrong usage or input, 3 the
    engine crashed, hung or could not be started.
    """
    from omegadot.commands.check.check import check_engine
    from omegadot.commands.check.select import Arguments

    arguments = Arguments(
        scenarios=scenario or [],
        exceptions=exceptions or [],
        baseline=baseline,
        update=update_baseline,
        timeout=timeout,
    )
    as_json = output is Format.json
    raise typer.Exit(check_engine(adapter, integrator or [], arguments, as_json))
