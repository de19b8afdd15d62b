"""The command line: its commands, and what becomes of an error."""

from __future__ import annotations

import errno
import re
import sys
import traceback
import warnings
from typing import Annotated

import typer

from omegadot.commands.check.command import check
from omegadot.commands.choose.command import choose
from omegadot.commands.compare.command import compare
from omegadot.commands.engines.command import engines
from omegadot.commands.faults.command import faults
from omegadot.commands.findings.command import findings
from omegadot.commands.fit.command import fit
from omegadot.commands.options import ENDED, INTERRUPTED, PlainHelp
from omegadot.commands.report.command import report
from omegadot.commands.run.command import run
from omegadot.commands.scenarios.command import scenarios
from omegadot.commands.schemes.command import schemes
from omegadot.commands.score.command import score
from omegadot.commands.signals import as_before, code_of, end_like_ctrl_c
from omegadot.commands.streams import discard, on_one_line, prepare_streams
from omegadot.commands.versions.command import versions

# Of a longer word half of this is printed: an argument may be a file's whole content.
LONGEST_WORD = 400

EXIT_CODES = (
    "Exit codes: 0 done, and what was held to something holds; 1 something does not; 2 wrong usage "
    "or input; 3 an engine or the system failed. " + ENDED
)

app = typer.Typer(
    name="omegadot",
    help="Check rigid-body physics engines against exact solutions.",
    epilog=EXIT_CODES,
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # plain help: importing what frames it takes half of its time
    context_settings={"help_option_names": ["-h", "--help"]},
)


# Short enough for one line of 80 columns, the longest name included.
for command, short_help in (
    (run, "Run scenarios on engines, judge them, write a report."),
    (engines, "List the engines, their integrators and settings."),
    (scenarios, "List the built-in scenarios and what each shows."),
    (schemes, "Identify the scheme of every integrator by its steps."),
    (check, "Check one engine, built in or your own."),
    (faults, "Inject known faults and show which gate catches them."),
    (findings, "List where engines diverge, each shown in two ways."),
    (choose, "Find engine, integrator and step for a requirement."),
    (report, "Draw the report of a stored run, or of two runs."),
    (score, "Score a trajectory or log of any simulator."),
    (fit, "Fit a body and its motion to a log of omega."),
    (compare, "Compare two runs: what improved, what got worse."),
    (versions, "Find what changed between releases of an engine."),
):
    app.command(cls=PlainHelp, short_help=short_help)(command)


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


def main(received: list[int] | None = None) -> None:
    """Entry point: wrong input is one sentence on standard error and exit code 2.

    received: what `end_like_ctrl_c` has given, where signals are taken already.
    """
    prepare_streams()
    if not sys.warnoptions:  # of sums over a wrong engine's numbers; gates judge what comes of them
        warnings.simplefilter("ignore", RuntimeWarning)
    received = end_like_ctrl_c() if received is None else received
    try:
        code = app(standalone_mode=False)
        sys.stdout.flush()
    except typer.Abort as abort:  # of Ctrl-C, and the parser makes it of an EOFError too
        early = abort.__cause__ or abort.__context__
        if isinstance(early, EOFError):
            _print_error(_ends_early(early))
            sys.exit(3)
        code = INTERRUPTED
    except KeyboardInterrupt:
        code = INTERRUPTED
    except SystemExit:  # the parser's own answer to a pipe of ours that broke
        code = 3
    except Exception as error:
        sentence = _sentence(error)
        if sentence is None:
            raise
        if isinstance(error, OSError):
            discard(1)  # else Python tries once more to write what is left, as it ends
        _print_error(sentence)
        sys.exit(3 if _is_our_own(error) else 2)
    finally:
        ended = code_of(received)
        as_before(received)
    if code == INTERRUPTED:  # the parser makes this number of Ctrl-C, and prints nothing
        _print_error("interrupted.")
        code = ended
    sys.exit(code if isinstance(code, int) else 0)


def _ends_early(error: EOFError) -> str:
    """What an EOFError comes to, and the line at which it does: of a module, the one imported."""
    frames = traceback.extract_tb(error.__traceback__)
    own = [frame for frame in frames if not frame.filename.startswith("<frozen ")]
    where = f" at {own[-1].filename}, line {own[-1].lineno} ({own[-1].line})" if own else ""
    loads = any("importlib" in frame.filename for frame in frames)
    advice = "; remove the __pycache__ folder of the module that is imported there" if loads else ""
    return f"raised: EOFError: {error}{where}: what is read ends early{advice}."


def _print_error(sentence: str) -> None:
    try:
        print(f"omegadot: {_short(sentence)}", file=sys.stderr, flush=True)
    except OSError:  # of a full disk the exit code is all that can be reported
        discard(2)


def _short(sentence: str) -> str:
    """Without what steers a terminal, and with the beginning of a very long word alone."""
    long = rf"(\S{{{LONGEST_WORD // 2}}})\S{{{LONGEST_WORD // 2},}}"
    return re.sub(long, r"\1...", on_one_line(sentence))


# What is wrong with a path that was given; another one is right. All else is the system's.
_WRONG_PATH = {
    *(errno.ENAMETOOLONG, errno.ENOENT, errno.ENOTDIR, errno.EISDIR, errno.ELOOP, errno.EINVAL),
    *(errno.EACCES, errno.EPERM, errno.EROFS, errno.EEXIST, errno.EBUSY, errno.ENXIO),
}


def _is_our_own(error: Exception) -> bool:
    """Whether the system or a worker of ours failed, rather than the arguments being wrong."""
    failed = error if isinstance(error, OSError) else error.__cause__
    if isinstance(failed, OSError):
        return failed.filename is None or failed.errno not in _WRONG_PATH
    engines = sys.modules.get("omegadot.harness.engines")
    return engines is not None and isinstance(error, engines.NoTruthError)


def _sentence(error: Exception) -> str | None:
    """The sentence of an error that the user can correct; None for any other."""
    if hasattr(error, "format_message"):  # what the command-line parser raises
        text = " ".join(str(error.format_message()).split())
        return text if text.endswith(".") else f"{text}."
    if isinstance(error, OSError):
        if error.errno == errno.ENOENT and error.filename is None:
            return "the current folder does not exist any more; change to another."
        where = error.filename or "standard output"
        return f"{where}: cannot be used ({error.strerror or type(error).__name__})."
    from omegadot.adapters.registry import AdapterError
    from omegadot.harness.usage import UsageError
    from omegadot.reference_impl.arithmetic.precision import ExtendedTypeError
    from omegadot.reports.record.schema import RecordError
    from omegadot.scenarios import ScenarioError

    wrong_input = AdapterError | ExtendedTypeError | RecordError | ScenarioError | UsageError
    return str(error) if _is_our_own(error) or isinstance(error, wrong_input) else None
