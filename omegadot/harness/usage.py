"""Wrong usage: the error of a command's arguments, and the nearest valid name."""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable
from numbers import Integral, Real
from typing import get_args

from omegadot.adapters.protocol import Setup
from omegadot.written import written

MOST = 1e9


class UsageError(ValueError):
    """Arguments that cannot be used; the message is one sentence."""


MOST_NAMES = 30  # in one sentence


def nearest(term: str, known: Iterable[str]) -> str:
    """Advice: the nearest valid name, or, where none is near, all of them, or many."""
    names = sorted(set(known))
    by_lower = {name.lower(): name for name in names}
    close = difflib.get_close_matches(term.lower(), by_lower, 1)
    if close:
        return f"write {by_lower[close[0]]}"
    if len(names) > MOST_NAMES:
        listed = ", ".join(names[:MOST_NAMES])
        return f"choose {listed} or one of {len(names) - MOST_NAMES} others"
    *first, last = names
    return f"choose {', '.join(first)} or {last}" if first else f"choose {last}"


def check_setup(setup: object, *more: str) -> None:
    """Raise UsageError unless it is a setup, or one of `more`: any other name would leave shipped
    defaults on.
    """
    if setup not in (known := (*get_args(Setup), *more)):
        raise UsageError(f"--setup {setup}: no such setup; {nearest(str(setup), known)}.")


def check_number(option: str, value: object, least: float) -> None:
    """Raise UsageError unless it is a number above 0, from `least` on, and no larger than 1e9.

    Seconds, GiB and kilograms beyond that are mistyped; the system's clock refuses them as well.
    """
    try:
        number = float(value) if isinstance(value, Real) else math.nan
    except OverflowError:  # a whole number that no float holds
        number = math.inf
    if not (least <= number <= MOST and number > 0.0):
        limit = f"of at least {written(least)}" if least else "above 0"
        limit += f" and at most {written(MOST)}" if number > MOST else ""
        raise UsageError(f"{option} {value}: give a number {limit}.")


def check_count(option: str, value: object, least: int, most: int | None = None) -> None:
    """Raise UsageError unless it is a whole number, from `least` on, up to `most`."""
    if not isinstance(value, Integral) or int(value) < least:
        raise UsageError(f"{option} {value}: give a whole number of at least {least}.")
    if most is not None and int(value) > most:
        raise UsageError(f"{option} {value}: give a whole number of at most {most}.")
