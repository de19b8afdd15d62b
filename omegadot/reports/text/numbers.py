"""How numbers are written: short, in scientific form, the same in the terminal and on the page."""

from __future__ import annotations

import math
from collections.abc import Sequence


def short(value: float | None, digits: int = 2) -> str:
    """A number to `digits` significant digits: 3.1e-15, 0, not finite, or – where there is none."""
    if value is None:
        return "–"
    if not math.isfinite(value):
        return "not finite"
    if value == 0.0:
        return "0"
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    return mantissa if int(exponent) == 0 else f"{mantissa}e{int(exponent)}"


def plain(value: float | None) -> str:
    """A setting as its author would write it: 0.005, not 5e-3; – where there is none."""
    return "–" if value is None else f"{value:.6g}"


def times(count: int, noun: str) -> str:
    """A count with its noun: 1 scenario, 3 scenarios."""
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def listed(names: Sequence[str]) -> str:
    """Names in a row: a, b and c."""
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def knob(timestep: float | None, accuracy: float | None) -> str:
    """The step or the accuracy of a run, as text."""
    if timestep is not None:
        return f"step {plain(timestep)} s"
    return "" if accuracy is None else f"accuracy {plain(accuracy)}"
