"""The arguments of ``omegadot run``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from omegadot.commands.options import Format, Setup, command_line, on_a_terminal


def run(
    scenarios: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[SCENARIO]...",
            help="Built-in names or paths. Default: all built-in scenarios.",
        ),
    ] = None,
    engine: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME[:INTEGRATOR]",
            help="An engine, or one of its integrators; repeatable. Default: all installed.",
        ),
    ] = None,
    timestep: Annotated[
        list[float] | None,
        typer.Option(metavar="S", help="A time step in s instead of the scenario's; repeatable."),
    ] = None,
    out: Annotated[
        Path, typer.Option(metavar="DIR", help="Folder for the record and its report.")
    ] = Path("omegadot-run"),
    setup: Annotated[
        Setup,
        typer.Option(
            help="physics: defaults that disturb the motion are off; as-shipped: all defaults."
        ),
    ] = Setup.physics,
    adapter: Annotated[
        list[str] | None,
        typer.Option(metavar="FILE.py:CLASS", help="An engine of your own; repeatable."),
    ] = None,
    exceptions: Annotated[
        list[Path] | None,
        typer.Option(metavar="FILE", help="Known failures, declared in TOML; repeatable."),
    ] = None,
    timeout: Annotated[
        float,
        typer.Option(metavar="S", min=0.1, help="Time limit in s for one request to an engine."),
    ] = 60.0,
    jobs: Annotated[
        int | None,
        typer.Option(
            metavar="N",
            min=1,
            help="Number of engines that run at the same time. Default: all cores.",
        ),
    ] = None,
    memory: Annotated[
        float | None,
        typer.Option(
            metavar="GIB",
            min=0.1,
            help="Memory limit for one engine, on Linux. Default: half of the machine's.",
        ),
    ] = None,
    seed: Annotated[
        int, typer.Option(metavar="INTEGER", min=0, help="Seed of the random states.")
    ] = 0,
    output: Annotated[Format, typer.Option("--format", help="Output format.")] = Format.text,
) -> None:
    """Run scenarios on engines, judge them, and write a record with its report.

    Exit codes: 0 every gate holds, 1 a gate fails, 2 wrong usage or input, 3 an engine crashed,
    timed out or could not be started.
    """
    from omegadot.commands.run.print_run import exit_code, print_json, print_text
    from omegadot.commands.run.result import RunInterrupted
    from omegadot.commands.run.run import run as run_scenarios

    if memory is not None and not _memory_is_limited():
        typer.echo("omegadot: --memory is ignored: this system keeps no such limit.", err=True)
    try:
        result = run_scenarios(
            scenarios or [],
            engine or [],
            timesteps=timestep or [],
            out=out,
            setup=setup.value,
            adapters=adapter or [],
            exceptions=exceptions or [],
            timeout=timeout,
            jobs=jobs,
            memory=memory,
            seed=seed,
            command=command_line(),
            progress=on_a_terminal(),
        )
    except RunInterrupted as interrupted:
        result = interrupted.result
    if output is Format.json:
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
