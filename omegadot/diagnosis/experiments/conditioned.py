"""A cause with the condition that experiments have found."""

from __future__ import annotations

import re

from omegadot.diagnosis.wording.implied import only_where
from omegadot.diagnosis.wording.no_lever import no_lever

UNKNOWN = "none is known"
END = r"(?= \(\S+; other numbers|; |$)"
# What is said of some scenarios where no condition is known, or by what scenarios alone show.
OF_SOME = re.compile(
    r"(?:, on \d+ scenarios?)?, not on \d+ others? that would show it"
    rf"|, but not always|, but only where .*?{END}"
)
ALONE = re.compile(rf"; it is so in scenarios alone where .*?{END}")
WHERE = re.compile(rf", but only where (.*?){END}")
# Where a rounding leaves a number as it is, no size decides.
LIMIT, ROUNDED = "a limit between", re.compile(r"is rounded to|is taken for zero")
# What acts on some numbers alone by what it is.
BY_ITSELF = re.compile(r"is limited to|held above|is rounded to|is taken for zero")


def conditioned(text: str, condition: str) -> str:
    """The cause, on this condition; as it is where there is none, or where the cause implies it."""
    if not condition or (LIMIT in condition and ROUNDED.search(text)):
        return text
    if text.startswith(UNKNOWN):
        return f"{ALONE.sub('', text)}; it is so only where {condition}"
    plain = no_lever(OF_SOME.sub("", text), condition)
    either = "either " in plain or "; " in plain
    if either:
        return f"{plain}; it is so only where {condition}"
    return plain + only_where(plain, condition)


def condition_in(text: str) -> str:
    """The condition that a cause already has; "" without any."""
    found = WHERE.search(text)
    return found.group(1) if found else ""


def without_condition(text: str) -> str:
    """The same where its condition is contradicted."""
    return WHERE.sub(", but not always", text)


def not_always(text: str) -> str:
    """A cause that experiments have seen not to act, on no condition that is known."""
    said = text.startswith(UNKNOWN) or "either " in text or "; " in text
    by_itself = OF_SOME.search(text) or BY_ITSELF.search(text)
    return text if said or by_itself else f"{text}, but not always"
