"""The command line: its commands, and what becomes of an error."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from omegadot.commands.check.command import check
from omegadot.commands.choose.command import choose
from omegadot.commands.compare.command import compare
from omegadot.commands.engines.command import engines
from omegadot.commands.faults.command import faults
from omegadot.commands.report.command import report
from omegadot.commands.run.command import run
from omegadot.commands.scenarios.command import scenarios
from omegadot.commands.schemes.command import schemes
from omegadot.commands.score.command import score
from omegadot.commands.versions.command import versions

INTERRUPTED = 130  # as shells count: 128 + SIGINT

app = typer.Typer(
    name="omegadot",
    help="Cross-validate rigid-body engines against a readable Newton-Euler reference.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # plain help: importing what frames it takes half of its time
    context_settings={"help_option_names": ["-h", "--help"]},
)


# Short enough for a line of 80 columns beside the longest name.
app.command(short_help="Run scenarios on engines, judge them, write a report.")(run)
app.command(short_help="List the engines and what each is set to.")(engines)
app.command(short_help="List the built-in scenarios and what each shows.")(scenarios)
app.command(short_help="Name the scheme of every integrator, from its steps.")(schemes)
app.command(short_help="Put one engine, your own too, through every check.")(check)
app.command(short_help="Break sound engines in known ways: what catches it?")(faults)
app.command(short_help="Find engine, integrator and step for a requirement.")(choose)
app.command(short_help="Draw the page of a stored run again, or of two runs.")(report)
app.command(short_help="Score a trajectory of any simulator, or a log.")(score)
app.command(short_help="Say what changed from one run to another.")(compare)
app.command(short_help="Tell what changed between releases of an engine.")(versions)


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
        code = INTERRUPTED
    except Exception as error:
        sentence = _sentence(error)
        if sentence is None:
            raise
        print(f"omegadot: {sentence}", file=sys.stderr)
        sys.exit(3 if _is_our_own(error) else 2)
    if code == INTERRUPTED:  # the parser makes this number of Ctrl-C, and says nothing
        print("omegadot: interrupted.", file=sys.stderr)
    sys.exit(code if isinstance(code, int) else 0)


def _is_our_own(error: Exception) -> bool:
    """Whether a worker of ours failed to start, rather than the words being wrong."""
    engines = sys.modules.get("omegadot.harness.engines")
    return engines is not None and isinstance(error, engines.NoTruthError)


def _sentence(error: Exception) -> str | None:
    """The sentence of an error that is the user's to mend; None of any other."""
    if hasattr(error, "format_message"):  # what the command-line parser raises
        text = " ".join(str(error.format_message()).split())
        return text if text.endswith(".") else f"{text}."
    from omegadot.adapters.registry import AdapterError
    from omegadot.harness.usage import UsageError
    from omegadot.reports.record.schema import RecordError
    from omegadot.scenarios import ScenarioError

    if _is_our_own(error):
        return str(error)
    if isinstance(error, AdapterError | UsageError | RecordError | ScenarioError):
        return str(error)
    return None
