"""The one error of this room, and how a value that a user wrote is shown in it."""

from __future__ import annotations

import datetime

from omegadot.written import exactly

SHOWN = 60  # characters of a value that a sentence can carry


class ScenarioError(ValueError):
    """A scenario that cannot be run, reported in one sentence.

    file: the path as given, or the built-in's name.  key: dotted path such as
    ``body.part[1].radius`` (lists count from 0), or None where the file as a whole is at fault.
    found: what stands there.  advice: what to do.
    """

    def __init__(self, file: str, key: str | None, found: str, advice: str) -> None:
        self.file = file
        self.key = key
        self.found = found
        self.advice = advice
        super().__init__(file, key, found, advice)

    def __str__(self) -> str:
        place = self.file if self.key is None else f"in {self.file}, {self.key}"
        return f"{place} is {self.found}; {self.advice}."


class Phrase(str):
    """Text to show as it stands: not a value that the user wrote."""

    __slots__ = ()


def printable(text: str) -> str:
    """The text itself, or its ``repr`` where it holds control characters; cut when long."""
    shown = text if text.isprintable() and text else repr(text)
    return shown if len(shown) <= 4 * SHOWN else shown[: 4 * SHOWN] + "..."


def describe(value: object, depth: int = 2) -> str:
    """A value in TOML's own spelling, in at most about ``SHOWN`` characters, safe to print."""
    match value:
        case Phrase():
            return str(value)
        case bool():
            return "true" if value else "false"
        case int() if value.bit_length() > 4 * SHOWN:  # a decimal spelling may be refused by Python
            return f"an integer of {value.bit_length()} bits"
        case str():
            return repr(value) if len(value) <= SHOWN else repr(value[:SHOWN]) + "..."
        case int():
            return repr(value)
        case float():
            text = exactly(value)
            return text if {*".enf"} & {*text} else f"{text}.0"  # a float, no whole number
        case datetime.date() | datetime.time():
            return value.isoformat()
        case dict():
            return "a table"
        case list() | tuple():
            return _describe_list(value, depth)
        case _:
            return f"a value of type {type(value).__name__}"


def _describe_list(value: list[object] | tuple[object, ...], depth: int) -> str:
    if depth == 0:
        return "[...]"
    items = [describe(item, depth - 1) for item in value[:9]]
    shown = "[" + ", ".join(items) + (", ...]" if len(value) > len(items) else "]")
    return shown if len(shown) <= 3 * SHOWN else f"a list of {len(value)} values"
