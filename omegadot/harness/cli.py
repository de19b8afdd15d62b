"""The command line: ``omegadot run | check | engines | scenarios | schemes | faults | report``."""

from __future__ import annotations

import sys
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer(
    name="omegadot",
    help="Cross-validate rigid-body engines against a readable Newton-Euler reference.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


class Format(StrEnum):
    """How results are printed."""

    text = "text"
    json = "json"


class PageFormat(StrEnum):
    """How results are printed that may also become a page."""

    text = "text"
    json = "json"
    markdown = "markdown"


class Setup(StrEnum):
    """Engines with what spoils physics switched off, or as they come."""

    physics = "physics"
    as_shipped = "as-shipped"


@app.command()
def run(
    scenarios: Annotated[
        list[str] | None,
        typer.Argument(metavar="[SCENARIO]...", help="Built-in names or paths; default: all."),
    ] = None,
    engine: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME[:INTEGRATOR]", help="An engine; repeat for more. Default: all."),
    ] = None,
    timestep: Annotated[
        list[float] | None,
        typer.Option(metavar="S", help="A time step in s, instead of the scenario's; repeatable."),
    ] = None,
    out: Annotated[Path, typer.Option(metavar="DIR", help="Where the record goes.")] = Path(
        "omegadot-run"
    ),
    setup: Annotated[Setup, typer.Option(help="How engines are configured.")] = Setup.physics,
    adapter: Annotated[
        list[str] | None,
        typer.Option(metavar="FILE.py:CLASS", help="An engine of your own; repeatable."),
    ] = None,
    exceptions: Annotated[
        list[Path] | None,
        typer.Option(metavar="FILE", help="Known failures, declared in TOML; repeatable."),
    ] = None,
    timeout: Annotated[
        float, typer.Option(metavar="S", min=0.1, help="Limit for one request to an engine.")
    ] = 60.0,
    jobs: Annotated[
        int | None,
        typer.Option(metavar="N", min=1, help="Engines at the same time. Default: cores."),
    ] = None,
    memory: Annotated[
        float | None,
        typer.Option(metavar="GIB", min=0.1, help="Limit for one engine. Default: half of it all."),
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="For the random states.")] = 0,
    output: Annotated[Format, typer.Option("--format", help="What to print.")] = Format.text,
) -> None:
    """Run scenarios on engines, judge them, and write a record with its report.

    Exit codes: 0 every gate holds, 1 a gate fails, 2 wrong usage or input, 3 an engine crashed,
    hung or could not be started.
    """
    import os

    from omegadot.harness.checks.exceptions import exceptions_of
    from omegadot.harness.command_run import run_and_write
    from omegadot.harness.outcome import RunRequest
    from omegadot.harness.print_run import print_json, print_text
    from omegadot.harness.usage import case_of, engine_choices, scenarios_of
    from omegadot.reports.record import check_folder

    choices = engine_choices(engine or [], adapter or [])
    cases = [case_of(scenario, timestep or []) for scenario in scenarios_of(scenarios or [])]
    known = exceptions_of(choices, exceptions or [])
    check_folder(out)
    jobs = jobs or os.cpu_count() or 1
    request = RunRequest(cases, choices, setup.value, seed, timeout, jobs, memory)
    record, code = run_and_write(request, out, ["omegadot", *sys.argv[1:]], known)
    if output is Format.json:
        print_json(record, out, code)
    else:
        print_text(record, out)
    raise typer.Exit(code)


@app.command()
def engines(
    output: Annotated[Format, typer.Option("--format", help="What to print.")] = Format.text,
    adapter: Annotated[
        list[str] | None,
        typer.Option(metavar="FILE.py:CLASS", help="An engine of your own; repeatable."),
    ] = None,
) -> None:
    """List the engines: installed or not, versions, integrators, conventions, what is off."""
    from omegadot.harness.command_engines import print_engines

    print_engines(adapter or [], as_json=output is Format.json)


@app.command()
def scenarios(
    output: Annotated[Format, typer.Option("--format", help="What to print.")] = Format.text,
) -> None:
    """List the built-in scenarios and what each shows."""
    from omegadot.harness.command_scenarios import print_scenarios

    print_scenarios(as_json=output is Format.json)


@app.command()
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
    from omegadot.harness.command_schemes import print_schemes

    raise typer.Exit(print_schemes(engine or [], adapter or [], python or [], output.value))


@app.command()
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
    from omegadot.harness.checks.select import Words
    from omegadot.harness.command_check import check_engine

    words = Words(
        scenarios=scenario or [],
        exceptions=exceptions or [],
        baseline=baseline,
        update=update_baseline,
        timeout=timeout,
    )
    as_json = output is Format.json
    raise typer.Exit(check_engine(adapter, integrator or [], words, as_json))


@app.command()
def faults(
    engine: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME", help="A built-in engine; repeat for more. Default: reference."
        ),
    ] = None,
    bodies: Annotated[
        int, typer.Option(metavar="N", min=1, help="Random bodies for each fault.")
    ] = 5,
    seed: Annotated[int, typer.Option(min=0, help="For the random bodies.")] = 0,
    output: Annotated[
        PageFormat, typer.Option("--format", help="What to print.")
    ] = PageFormat.text,
) -> None:
    """Break sound engines in known ways and show which gate catches what, and how often.

    Exit codes: 0 every fault is caught on every body and nothing sound is accused, 1 not so,
    2 wrong usage.
    """
    from omegadot.harness.command_faults import print_faults

    raise typer.Exit(print_faults(engine or [], bodies, seed, output.value))


@app.command()
def report(
    folder: Annotated[Path, typer.Argument(metavar="RUN", help="The folder of a run.")],
) -> None:
    """Draw the page of a stored run again."""
    from omegadot.harness.command_report import redraw

    typer.echo(redraw(folder))


def _version(show: bool) -> None:
    if show:
        from omegadot import __version__

        typer.echo(f"omegadot {__version__}")
        raise typer.Exit


@app.callback()
def _root(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    pass


def main() -> None:
    """Entry point: wrong input is one sentence on standard error and exit code 2."""
    try:
        code = app(standalone_mode=False)
    except (typer.Abort, KeyboardInterrupt):
        print("omegadot: interrupted.", file=sys.stderr)
        sys.exit(130)
    except Exception as error:
        sentence = _sentence(error)
        if sentence is None:
            raise
        print(f"omegadot: {sentence}", file=sys.stderr)
        sys.exit(2)
    sys.exit(code if isinstance(code, int) else 0)


def _sentence(error: Exception) -> str | None:
    """The sentence of an error that is the user's to mend; None of any other."""
    if hasattr(error, "format_message"):  # what the command-line parser raises
        text = " ".join(str(error.format_message()).split())
        return text if text.endswith(".") else f"{text}."
    from omegadot.adapters.registry import AdapterError
    from omegadot.harness.usage import UsageError
    from omegadot.reports.schema import RecordError
    from omegadot.scenarios import ScenarioError

    if isinstance(error, AdapterError | UsageError | RecordError | ScenarioError):
        return str(error)
    return None
