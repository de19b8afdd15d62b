"""The help of a command: plain names of its arguments, without the parser's own notation."""

from __future__ import annotations

from enum import Enum
from typing import Any

from typer.core import TyperCommand


class PlainHelp(TyperCommand):
    """A command whose usage reads ``omegadot check [OPTIONS] ADAPTER``.

    An argument is shown by its metavar, and an option by its names and its metavar or its choices.
    Types and ranges of the parser are left out: the help text of an option states its unit.
    """

    def collect_usage_pieces(self, ctx: Any) -> list[str]:
        """``[OPTIONS]`` and the arguments by their metavars."""
        return ["[OPTIONS]", *(_metavar(p) for p in self.params if _is_argument(p))]

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
    choices = _choices(param)
    return f"{names} {'|'.join(choices) if choices else _metavar(param)}"


def _choices(param: Any) -> list[str]:
    """The values of an option that has a fixed set of them, which is an Enum's here."""
    default = param.default
    if param.metavar is None and isinstance(default, Enum):
        return [str(member.value) for member in type(default)]
    return []


def _help(param: Any) -> str:
    text, default = str(param.help or ""), param.default
    if isinstance(default, Enum):
        default = default.value
    if _is_argument(param) or param.is_flag or default in (None, "", (), []):
        return text
    return (
        f"{text} [default: {default:g}]"
        if isinstance(default, float)
        else (f"{text} [default: {default}]")
    )
