"""The arguments of ``omegadot check``."""

from __future__ import annotations

from typing import Annotated

import typer

from omegadot.commands.options import Format, on_a_terminal


def check(
    adapter: Annotated[
        str,
        typer.Argument(metavar="ADAPTER", help="An engine's name, FILE.py:Class or module:Class."),
    ],
    scenario: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="A built-in name or a path; repeatable. Default: all built-in scenarios.",
        ),
    ] = None,
    integrator: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="An integrator; repeatable. Default: all."),
    ] = None,
    exceptions: Annotated[
        list[str] | None,
        typer.Option(metavar="FILE", help="Known failures, declared in TOML; repeatable."),
    ] = None,
    baseline: Annotated[
        str | None, typer.Option(metavar="DIR", help="Compare with the values stored in DIR.")
    ] = None,
    update_baseline: Annotated[
        bool,
        typer.Option(
            "--update-baseline",
            help="Store the values in --baseline DIR instead of comparing.",
        ),
    ] = False,
    timeout: Annotated[
        float,
        typer.Option(metavar="S", min=0.1, help="Time limit in s for one request to an engine."),
    ] = 60.0,
    output: Annotated[Format, typer.Option("--format", help="Output format.")] = Format.text,
) -> None:
    """Check one engine, built in or your own, at every gate.

    Exit codes: 0 every check holds, 1 one fails or all were skipped, 2 wrong usage or input, 3 the
    engine crashed, timed out or could not be started.
    """
    from omegadot.commands.check.check import check as check_engine
    from omegadot.commands.check.print_checks import exit_code, print_checks, print_json

    found = check_engine(
        adapter,
        scenarios=scenario or [],
        integrators=integrator or [],
        exceptions=exceptions or [],
        baseline=baseline,
        update_baseline=update_baseline,
        timeout=timeout,
        progress=on_a_terminal(),
    )
    if output is Format.json:
        print_json(found)
    else:
        print_checks(found)
    raise typer.Exit(exit_code(found))
