"""Wrong usage: the error of a command's arguments, and the nearest valid name."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


class UsageError(ValueError):
    """Arguments that cannot be used; the message is one sentence."""


def nearest(term: str, known: Iterable[str]) -> str:
    """Advice: the nearest valid name, or, where none is near, all of them."""
    names = sorted(known)
    close = difflib.get_close_matches(term, names, 1)
    return f"write {close[0]}" if close else f"give one of {', '.join(names)}"
