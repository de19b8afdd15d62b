"""The command line: its commands, and what becomes of an error."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from omegadot.harness.commands.check import check
from omegadot.harness.commands.choose import choose
from omegadot.harness.commands.compare import compare
from omegadot.harness.commands.engines import engines
from omegadot.harness.commands.faults import faults
from omegadot.harness.commands.report import report
from omegadot.harness.commands.run import run
from omegadot.harness.commands.scenarios import scenarios
from omegadot.harness.commands.schemes import schemes
from omegadot.harness.commands.score import score
from omegadot.harness.commands.versions import versions

INTERRUPTED = 130  # as shells count: 128 + SIGINT

app = typer.Typer(
    name="omegadot",
    help="Cross-validate rigid-body engines against a readable Newton-Euler reference.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


app.command()(run)
app.command()(engines)
app.command()(scenarios)
app.command()(schemes)
app.command()(check)
app.command()(faults)
app.command()(choose)
app.command()(report)
app.command()(score)
app.command()(compare)
app.command()(versions)


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
    workers = sys.modules.get("omegadot.harness.workers")
    return workers is not None and isinstance(error, workers.NoTruthError)


def _sentence(error: Exception) -> str | None:
    """The sentence of an error that is the user's to mend; None of any other."""
    if hasattr(error, "format_message"):  # what the command-line parser raises
        text = " ".join(str(error.format_message()).split())
        return text if text.endswith(".") else f"{text}."
    from omegadot.adapters.registry import AdapterError
    from omegadot.harness.usage_error import UsageError
    from omegadot.reports.schema import RecordError
    from omegadot.scenarios import ScenarioError

    if _is_our_own(error):
        return str(error)
    if isinstance(error, AdapterError | UsageError | RecordError | ScenarioError):
        return str(error)
    return None
