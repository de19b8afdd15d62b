"""The units that each quantity may be written in, and quantities such as ``0.1deg`` or ``1%``."""

from __future__ import annotations

import math
import re
from numbers import Real

from omegadot.harness.usage import UsageError, nearest

DEGREE = math.pi / 180.0
UNITS: dict[str, dict[str, float]] = {
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0},
    "angle": {
        **{"rad": 1.0, "deg": DEGREE, "mrad": 1e-3, "rev": 2.0 * math.pi, "urad": 1e-6},
        **{"arcmin": DEGREE / 60.0, "arcsec": DEGREE / 3600.0},
    },
    "rate": {
        **{"rad/s": 1.0, "deg/s": DEGREE, "mrad/s": 1e-3, "rev/s": 2.0 * math.pi},
        **{"rpm": math.pi / 30.0, "deg/h": DEGREE / 3600.0, "urad/s": 1e-6},
    },
    "length": {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "km": 1e3, "ft": 0.3048, "in": 0.0254},
    "ratio": {"1": 1.0, "%": 1e-2, "ppm": 1e-6, "ppb": 1e-9},
    "factor": {"1": 1.0, "x": 1.0},
}
"""By quantity, each unit's value in SI. The plainer stand first, which `score --detect` prefers."""

_NAMES = {"time": "a time", "angle": "an angle", "rate": "an angular velocity"}
_NAMES |= {"length": "a length", "ratio": "a ratio", "factor": "a factor"}
_EXAMPLES = {"time": "60s, 5ms or 1min", "angle": "0.1deg or 1e-3rad", "rate": "0.5deg/s or 2rpm"}
_EXAMPLES |= {"length": "1mm or 0.1m", "ratio": "1e-6, 1ppm or 0.01%", "factor": "100"}
SPELLINGS = {"µ": "u", "μ": "u", "°": "deg", "turn": "rev", "×": "x"}
_QUANTITY = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(\S*)\s*")


def unit_named(text: str, kind: str, where: str) -> str:
    """The unit of a quantity as UNITS spells it.

    kind: a key of UNITS.  where: the option, or file and key, for the error.  Raises UsageError.
    """
    units, unit = UNITS[kind], text
    for other, ours in SPELLINGS.items():
        unit = unit.replace(other, ours)
    if unit in units:
        return unit
    folded = {known.casefold(): known for known in units}.get(unit.casefold())
    advice = f"write {folded}" if folded else nearest(unit, units)
    raise UsageError(f"{where}: {text!r} is no unit of {_NAMES[kind]}; {advice}.")


def unit_written(text: str, kind: str, where: str) -> str:
    """The unit that a quantity is written in; SI's where none is. Raises UsageError."""
    found = _QUANTITY.fullmatch(text)
    return unit_named((found and found[2]) or next(iter(UNITS[kind])), kind, where)


def quantity(value: object, kind: str, where: str, needs_unit: bool = False) -> float:
    """A positive quantity in SI, of a number or of a text such as ``0.1 deg``.

    needs_unit: whether a bare number, taken to be in SI units, is refused where the quantity has a
    dimension.  Raises UsageError.
    """
    advice = f"write it as {_EXAMPLES[kind]}"
    if isinstance(value, bool) or not isinstance(value, str | Real):
        raise UsageError(f"{where} is {value!r}; {advice}.")
    found = _QUANTITY.fullmatch(str(value))
    if found is None:
        raise UsageError(f"{where}: {str(value)!r} is no quantity; {advice}.")
    if needs_unit and not found[2] and "1" not in UNITS[kind]:
        raise UsageError(f"{where}: {str(value)!r} has no unit; {advice}.")
    size = float(found[1]) * UNITS[kind][unit_written(str(value), kind, where)]
    if not (math.isfinite(size) and size > 0.0):
        raise UsageError(f"{where}: {value} is not a positive, finite quantity; give one.")
    return size
