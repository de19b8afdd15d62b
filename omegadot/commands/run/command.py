"""The arguments of ``omegadot run``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from omegadot.commands import options
from omegadot.commands.options import Texts, option


def run(
    scenarios: Annotated[
        Texts,
        typer.Argument(
            metavar="[SCENARIO]...",
            help="Built-in names, random-SEED-INDEX or paths. Default: all built-in scenarios.",
        ),
    ] = None,
    scenario: Annotated[
        Texts, option("NAME", "A scenario, as SCENARIO; repeatable.", "--scenario")
    ] = None,
    engines: Annotated[
        Texts,
        option(
            "NAME[:INTEGRATOR]",
            "An engine, or one of its integrators; repeatable. Default: all installed.",
            "--engine",
        ),
    ] = None,
    timesteps: Annotated[
        list[float] | None,
        option("S", "A time step in s instead of the scenario's; repeatable.", "--timestep"),
    ] = None,
    accuracies: Annotated[
        list[float] | None,
        option(
            "A",
            "An accuracy of error-controlled integrators, relative, instead of the scenario's; "
            "repeatable.",
            "--accuracy",
        ),
    ] = None,
    out: Annotated[Path, option("DIR", "Folder for the record and its report.")] = Path(
        "omegadot-run"
    ),
    setup: Annotated[
        options.Setups,
        typer.Option(
            help="physics: defaults that disturb the motion are off; as-shipped: all defaults; "
            "both: each engine in both, and which single setting mends most."
        ),
    ] = options.Setups.physics,
    via: options.Ways = None,
    adapters: options.Adapters = None,
    exceptions: options.Exceptions = None,
    timeout: options.Timeout = 60.0,
    jobs: options.Jobs = None,
    memory: Annotated[
        float | None,
        option(
            "GIB", "Memory limit for one engine, on Linux. Default: half of the machine's.", min=0.1
        ),
    ] = None,
    seed: Annotated[int, option("INTEGER", "Seed of the random states.", min=0)] = 0,
    output: options.Output = options.Format.text,
) -> None:
    """Run scenarios on engines, judge them, and write a record with its report.

    Exit codes: 0 every gate holds, 1 a gate fails, 2 wrong usage or input, 3 an engine crashed,
    timed out or could not be started, or an engine's model is all of it that could be judged, or
    nothing of one that was named, or the record could not be written where it was requested.
    """
    arguments = options.given(locals())
    named = [*arguments.pop("scenarios", []), *arguments.pop("scenario", [])]
    from omegadot.commands.run.print_run import exit_code, print_json, print_text
    from omegadot.commands.run.result import RunInterrupted, unwritten
    from omegadot.commands.run.run import run as run_scenarios

    if memory is not None and not _memory_is_limited():
        typer.echo("omegadot: --memory is ignored: this system keeps no such limit.", err=True)
    try:
        result = run_scenarios(named or None, **arguments, command=options.command_line())
    except RunInterrupted as interrupted:
        result = interrupted.result
    except KeyboardInterrupt:
        typer.echo(unwritten(out), err=True)
        raise
    if output is options.Format.json:
        print_json(result)
    else:
        print_text(result)
    raise typer.Exit(exit_code(result))


def _memory_is_limited() -> bool:
    """Whether the system keeps a limit of one process's data.

    Windows has none for a process alone; that of macOS is for `sbrk`, which no allocator there
    uses.
    """
    return sys.platform.startswith(("linux", "freebsd"))
