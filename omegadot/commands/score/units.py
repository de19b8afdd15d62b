"""Units that a trace may come in, in SI, and quantities as people write them."""

from __future__ import annotations

import math
import re

from omegadot.harness.usage import UsageError, nearest

DEGREE = math.pi / 180.0
TIME = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0}
ANGLE = {"rad": 1.0, "deg": DEGREE, "mrad": 1e-3, "rev": 2.0 * math.pi}
RATE = {
    "rad/s": 1.0,
    "deg/s": DEGREE,
    "mrad/s": 1e-3,
    "rev/s": 2.0 * math.pi,
    "rpm": 2.0 * math.pi / 60.0,
    "deg/h": DEGREE / 3600.0,
}
LENGTH = {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "km": 1e3, "ft": 0.3048, "in": 0.0254}
NUMBER = {"": 1.0, "1": 1.0, "%": 1e-2}
_QUANTITY = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(\S*)\s*$")


def scale(units: dict[str, float], unit: str, where: str) -> float:
    """The unit in SI. Raises UsageError naming `where` it was written."""
    if unit not in units:
        raise UsageError(f"{where} {unit}: no such unit; {nearest(unit, units)}.")
    return units[unit]


def quantity(units: dict[str, float], text: str, where: str) -> float:
    """A positive number with its unit, such as ``0.1deg``, in SI. Raises UsageError."""
    found = _QUANTITY.match(text)
    if not found:
        example = "0.1" + next(iter(units))
        raise UsageError(f"{where} {text}: not a number with a unit; write it like {example}.")
    value = float(found.group(1)) * scale(units, found.group(2), where)
    if not (value > 0.0 and math.isfinite(value)):
        raise UsageError(f"{where} {text}: must be positive and finite.")
    return value
