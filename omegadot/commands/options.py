"""What the commands' arguments share: option types, and how a command was started."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Mapping
from enum import Enum, StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperCommand

from omegadot.written import written


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
    """Engines with the defaults that disturb the motion switched off, or as shipped."""

    physics = "physics"
    as_shipped = "as-shipped"


class Setups(StrEnum):
    """One of the setups, or both."""

    physics = "physics"
    as_shipped = "as-shipped"
    both = "both"


def option(metavar: str, text: str, *names: str, **more: Any) -> Any:
    """An option: name of its value, help, and its own name where the argument has another."""
    return typer.Option(*names, metavar=metavar, help=text, **more)


Text = str | None
Texts = list[str] | None
# Options of several commands. An argument has the name that the function behind it has.
Output = Annotated[Format, typer.Option("--format", help="Output format.")]
PageOutput = Annotated[PageFormat, typer.Option("--format", help="Output format.")]
Adapters = Annotated[
    Texts,
    option(
        "FILE.py:CLASS",
        "An engine of your own, or a program that serves one with its arguments; repeatable.",
        "--adapter",
    ),
]
Ways = Annotated[
    Texts,
    option(
        "WAY",
        "How bodies go in: api, or urdf or mjcf through the engine's own reader of such files; "
        "repeatable. Default: api.",
        "--via",
    ),
]
Integrators = Annotated[
    Texts, option("NAME", "An integrator; repeatable. Default: all.", "--integrator")
]
Exceptions = Annotated[
    list[Path] | None, option("FILE", "Known failures, declared in TOML; repeatable.")
]
Timeout = Annotated[
    float,
    option(
        "S",
        "Time limit in s for one request to an engine; a start may take 20 s in any case.",
        min=0.1,
    ),
]
Jobs = Annotated[
    int | None,
    option("N", "Number of engines that run at the same time. Default: all cores.", min=1),
]


def given(arguments: Mapping[str, Any]) -> dict[str, Any]:
    """A command's ``locals()`` for the function behind it, which has the same arguments.

    What was not typed is left out, so that the function's own default holds; so is the format. How
    far the command is goes to a terminal.
    """
    found = {
        name: value.value if isinstance(value, StrEnum) else value
        for name, value in arguments.items()
        if value not in (None, []) and name != "output"
    }
    return {**found, "progress": on_a_terminal()}


NAME = "omegadot"
INTERRUPTED = 130  # as shells count: 128 + SIGINT
ENDED = (
    "Ended by a signal: 128 and its number, so 130 interrupted (Ctrl-C), 143 terminated, 129 "
    "terminal closed. A reader of the output that leaves early, like head, changes no exit code."
)


def exit_code(passed: bool, answered: bool) -> int:
    """0 everything holds, 1 something does not, 3 an engine failed to answer or to start."""
    if not answered:
        return 3
    return 0 if passed else 1


def command_line() -> list[str]:
    """The command as it was typed, for what is stored of it."""
    return [*program(), *sys.argv[1:]]


def program() -> list[str]:
    """How this very command is started again from the current folder: ``omegadot``, its path where
    it is on none of PATH's folders, or the interpreter with ``-m omegadot``.
    """
    started = Path(sys.argv[0])
    if started.name == "__main__.py" and started.parent.name == NAME:
        return [_typed(Path(sys.executable)), "-m", NAME]
    return [_typed(started)] if started.stem == NAME else [NAME]


def _typed(file: Path) -> str:
    """A program by its name where PATH leads to it, else by its path, in this folder relative."""
    found = shutil.which(file.stem)
    if found is not None and Path(found).absolute() == file.absolute():
        return file.stem
    here, there = Path.cwd(), file.absolute()
    return str(there.relative_to(here) if there.is_relative_to(here) else there)


def on_a_terminal() -> bool:
    """Whether a person sees standard error: how far a command is goes nowhere else."""
    return sys.stderr.isatty()


class PlainHelp(TyperCommand):
    """A command whose usage reads ``omegadot check [OPTIONS] ADAPTER``.

    An argument is shown by its metavar, and an option by its names and its metavar or its choices.
    Types and ranges of the parser are left out: the help text of an option states its unit.
    """

    def collect_usage_pieces(self, ctx: Any) -> list[str]:
        """``[OPTIONS]`` and the arguments by their metavars."""
        return ["[OPTIONS]", *(_metavar(p) for p in self.params if _is_argument(p))]

    def format_epilog(self, ctx: Any, formatter: Any) -> None:
        """The exit codes that all commands have, below what is the command's own."""
        super().format_epilog(ctx, formatter)
        formatter.write_paragraph()
        formatter.write_text(ENDED)

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """The arguments, then the options, each with its help and its default."""
        shown = [p for p in self.get_params(ctx) if not getattr(p, "hidden", False)]
        arguments = [(_metavar(p), _help(p)) for p in shown if _is_argument(p)]
        options = [(_option(p), _help(p)) for p in shown if not _is_argument(p)]
        for title, rows in (("Arguments", arguments), ("Options", options)):
            if rows:
                with formatter.section(title):
                    formatter.write_dl(rows)


def _is_argument(param: Any) -> bool:
    return bool(param.param_type_name == "argument")


def _metavar(param: Any) -> str:
    return str(param.metavar or param.name.upper())


def _option(param: Any) -> str:
    names = ", ".join(sorted(param.opts, key=len))
    if param.secondary_opts:
        return f"{names} / {', '.join(param.secondary_opts)}"
    if param.is_flag or param.count:
        return names
    if param.metavar is None and isinstance(param.default, Enum):
        return f"{names} {'|'.join(str(member.value) for member in type(param.default))}"
    return f"{names} {_metavar(param)}"


def _help(param: Any) -> str:
    text, default = str(param.help or ""), param.default
    if isinstance(default, Enum):
        default = default.value
    if _is_argument(param) or param.is_flag or default in (None, "", (), []):
        return text
    shown = written(default) if isinstance(default, float) else default
    return f"{text} [default: {shown}]"
