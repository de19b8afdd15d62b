"""A figure of one version, its name, and when two versions differ in it."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass

from omegadot.reports.text.numbers import short

# The first term of a metric's name: what kind of figure it is, in the order that they are reported
# in.
KINDS = ("convention", "default", "setup", "integrator", "scheme", "order", "drift", "equation")
RATIO = "energy ratio E/E0"
Name = tuple[str, ...]


@dataclass(frozen=True)
class Figure:
    """A metric's value in one version.

    value: a text, or a number with `band`: how far from it a sound engine of the same physics may
    be for rounding, or for how sharply an order is known.  None where it could not be determined.
    """

    value: str | float | None
    band: float = 0.0


def title(name: Name) -> str:
    """A metric's name as one writes it: order:RK4:free:attitude."""
    return ":".join(name)


def differ(one: Figure | None, other: Figure | None) -> bool:
    """Whether a metric changed: beyond both bands, or in its text, or by being there at all.

    What could not be determined in one of two versions reports nothing of a change.
    """
    if one is None or other is None:
        return one is not other
    a, b = one.value, other.value
    if a is None or b is None:
        return False
    if isinstance(a, str) or isinstance(b, str):
        return a != b
    if not (math.isfinite(a) and math.isfinite(b)):
        return math.isfinite(a) != math.isfinite(b)
    return not abs(a - b) <= one.band + other.band


def shown(name: Name, figure: Figure | None) -> str:
    """A figure in few characters."""
    if figure is None:
        return "none"
    if isinstance(figure.value, str):
        return figure.value
    if figure.value is None:
        return "not stated"
    if name[0] == "order":
        return f"{figure.value:.2f}"
    if name[-1] == RATIO:
        return f"{figure.value:.4f}"
    return short(figure.value)


def terms_of(text: str) -> set[str]:
    """The terms of a name, in lower case: what starts with a letter, and numbers."""
    found = re.findall(r"[a-z][a-z0-9]*|\d[\d.]*", text.lower())
    return {re.sub(r"(\.\d*?)0+$", r"\1", term).rstrip(".") for term in found}


def _compared(text: str) -> set[str]:
    """Terms as they are compared: an s at the end, as of several, does not count."""
    return {term.removesuffix("s") for term in terms_of(text)}


def unknown_metric(query: str, names: Iterable[Name]) -> list[str]:
    """The terms that are in no metric's name."""
    there = set().union(*(_compared(title(name)) for name in names))
    return [term for term in sorted(terms_of(query)) if term.removesuffix("s") not in there]


def matching(query: str, names: Iterable[Name], engine: str = "") -> list[Name]:
    """The metrics whose names have all of the terms, in any order."""
    wanted = _compared(query)
    return [n for n in names if wanted and wanted <= _compared(title((engine, *n)))]
