"""Numbers as text, with as many digits as it takes to see that two of them differ."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from omegadot.reference_impl.system import Array
from omegadot.written import written

MOST = 17
NOTHING = 1e-9  # of what it is held against, a number is zero
KNOWN_TO = 1e-7  # relative: six digits show no difference
NOISE = 1e-15  # relative: a fitted number is no better known


def number(value: float, other: float | None = None) -> str:
    """Six digits, or as many more as distinguish it from the other number."""
    if other is not None and abs(value) < NOTHING * abs(other):
        return "0"
    same = other is None or abs(value - other) <= NOISE * max(abs(value), abs(other))
    for digits in range(6, MOST):
        text = f"{written(value, digits)}"
        if same or text != f"{written(other, digits)}":
            return text
    return repr(value)


def vector(values: Array, other: Array | None = None) -> str:
    """``(x, y, z)``, with digits that distinguish it from the other vector."""
    others = [None] * len(values) if other is None else [float(v) for v in other]
    least = 1e3 * NOISE * float(np.max(np.abs(values)))
    kept = (0.0 if abs(v) <= least else float(v) for v in values)
    pairs = zip(kept, others, strict=True)
    return f"({', '.join(number(value, than) for value, than in pairs)})"


def factor(value: float) -> str:
    """A factor, with what it is of units or fractions: ``0.0174533 (pi/180)``.

    One that is nearly one as what it is off by, ``1 + 1e-12``.
    """
    off = value - 1.0
    if 0.0 < abs(off) < 5e-6:
        return f"1 {'+' if off > 0 else '-'} {written(abs(off), 3)}"
    known = [text for text, exact in KNOWN.items() if abs(value / exact - 1.0) <= KNOWN_TO]
    return f"{number(value)} ({known[0]})" if known else number(value)


def _known_factors() -> dict[str, float]:
    """Of units: degrees, turns and rpm, g, feet, inches, pounds and their forces and torques."""
    units = {"9.80665": 9.80665, "0.3048": 0.3048, "0.0254": 0.0254, "0.45359237": 0.45359237}
    units |= {"4.4482216": 4.4482216152605, "1.3558179": 1.3558179483314, "14.593903": 14.59390294}
    found = {f"1/{name}": 1.0 / value for name, value in units.items()} | units
    turns = {
        "pi/180": np.pi / 180,
        "180/pi": 180 / np.pi,
        "2 pi": 2 * np.pi,
        "1/(2 pi)": 0.5 / np.pi,
    }
    found |= turns | {"pi/30": np.pi / 30, "30/pi": 30 / np.pi}
    thirds = {f"{p}/{q}": p / q for q in (3, 6) for p in (1, 2, 4, 5, 7, 8) if p % 2 or q == 3}
    # those that their own digits show need no name
    signed = {f"-{name}": -value for name, value in (found | thirds).items()}
    return {
        name: value
        for name, value in (found | thirds | signed).items()
        if name.lstrip("-") != number(abs(value))
    }


def limits(low: float, high: float, unit: str) -> str:
    """What lies between two numbers: both, in digits that differ."""
    return f"{number(low, high)} and {number(high, low)} {unit}".strip()


def listed(names: Sequence[str]) -> str:
    """``a, b and c``."""
    return " and ".join(filter(None, (", ".join(names[:-1]), *names[-1:])))


KNOWN = _known_factors()
