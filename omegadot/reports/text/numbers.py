"""Numbers and names in the terminal, on the page and in comments: written in one way."""

from __future__ import annotations

import math
from collections.abc import Sequence

from omegadot.reports.text.engine_version import with_version
from omegadot.written import written


def short(value: float | None, digits: int = 2) -> str:
    """A measured number: 3.1e-15, 0.21, 0, not finite, or – where there is none."""
    if value is not None and not math.isfinite(value):
        return "not finite"
    return written(value, digits)


def magnitude(value: float | None) -> float:
    """For ordering: what is not a number is larger than any number."""
    return math.inf if value is None or math.isnan(value) else abs(value)


def times_its_bound(value: float | None, bound: float | None) -> float:
    """How many times its bound a value is; infinite where it is not finite or nothing is due."""
    size = magnitude(value)
    return size / bound if bound and math.isfinite(size) else math.inf


def plain(value: float | None) -> str:
    """A setting as its author would write it: 0.005, not 5e-3; – where there is none."""
    return written(value)


def grouped(value: float) -> str:
    """A plain factor to three digits: 1.06, 33, 2,465; with an exponent where it is extreme."""
    if not math.isfinite(value) or not 1e-3 <= abs(value) < 1e7:
        return short(value, 3)
    return f"{value:,.0f}" if abs(value) >= 100.0 else written(value, 3)


def times(count: int, noun: str) -> str:
    """A count with its noun: 1 scenario, 3 scenarios."""
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def listed(names: Sequence[str]) -> str:
    """Names in a row: a, b and c."""
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def first(names: Sequence[str], most: int) -> str:
    """As many names as `most`, and how many more there are: a, b and 3 more; or a, b."""
    more = len(names) - most
    return ", ".join(names[:most]) + (f" and {more} more" if more > 0 else "")


def quantity(value: float | None, unit: str, digits: int = 2) -> str:
    """A number with its unit; a pure number has none."""
    return short(value, digits) + ("" if unit == "1" else f" {unit}")


def angle(radians: float | None) -> str:
    """An angle in rad and in degrees: 2 rad (114 deg)."""
    return angles([] if radians is None else [radians])


def angles(radians: Sequence[float]) -> str:
    """The range of some angles in rad and in degrees: 1.9 to 2 rad (106 to 114 deg)."""
    if not radians:
        return "–"
    ends = sorted({min(radians), max(radians)})
    if not all(map(math.isfinite, ends)):
        return "not finite"
    both = (list(dict.fromkeys(map(text, ends))) for text in (short, degrees))
    in_rad, in_degrees = (" to ".join(texts) for texts in both)
    return f"{in_rad} rad ({in_degrees} deg)"


def degrees(radians: float) -> str:
    """An angle in degrees, without its unit: two digits, or three from 100 on."""
    value = math.degrees(radians)
    return short(value, 3 if abs(value) >= 100.0 else 2)


def engine_name(engine: str, version: str = "", setup: str | None = None) -> str:
    """An engine, its version where that is given, and its setup where it is not the usual one."""
    own = "" if setup == "physics" else setup
    return " ".join(filter(None, (with_version(engine, version), own)))


def knob(timestep: float | None, accuracy: float | None) -> str:
    """The step or the accuracy of a run, as text."""
    if timestep is not None:
        return f"step {plain(timestep)} s"
    return "" if accuracy is None else f"accuracy {plain(accuracy)}"
