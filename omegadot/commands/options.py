"""What the commands' arguments share: option types, and how a command was started."""

from __future__ import annotations

import sys
from enum import StrEnum


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


def command_line() -> list[str]:
    """The command as it was typed, for what is stored of it."""
    return ["omegadot", *sys.argv[1:]]


def on_a_terminal() -> bool:
    """Whether a person sees standard error: how far a command is goes nowhere else."""
    return sys.stderr.isatty()
