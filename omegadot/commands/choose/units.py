"""Quantities as people write them: ``0.1deg``, ``5 ms``, ``1%``."""

from __future__ import annotations

import math
import re

from omegadot.harness.usage import UsageError, nearest

DEGREE = math.pi / 180.0
KINDS: dict[str, dict[str, float]] = {
    "angle": {
        **{"rad": 1.0, "mrad": 1e-3, "urad": 1e-6, "µrad": 1e-6, "deg": DEGREE, "°": DEGREE},
        **{"arcmin": DEGREE / 60.0, "arcsec": DEGREE / 3600.0},
        **{"turn": 2.0 * math.pi, "rev": 2.0 * math.pi},
    },
    "rate": {
        **{"rad/s": 1.0, "mrad/s": 1e-3, "urad/s": 1e-6, "deg/s": DEGREE, "deg/h": DEGREE / 3600.0},
        **{"rpm": math.pi / 30.0, "rev/s": 2.0 * math.pi},
    },
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0},
    "ratio": {"%": 1e-2, "ppm": 1e-6, "ppb": 1e-9},
    "factor": {"x": 1.0, "×": 1.0},
}
# What a number without a unit is in.
PLAIN = {"angle": "rad", "rate": "rad/s", "time": "s", "ratio": "1", "factor": "1"}
_QUANTITY = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(\S*)")


def quantity(value: object, kind: str, where: str) -> float:
    """A positive quantity in SI units, of a number or of a text such as ``0.1 deg``.

    kind: a key of KINDS.  where: the option or file and key, for the error.  Raises UsageError.
    """
    if isinstance(value, bool) or not isinstance(value, str | int | float):
        raise UsageError(f"{where} is {value!r}; {_advice(kind)}.")
    found = _QUANTITY.fullmatch(str(value).strip())
    if found is None:
        raise UsageError(f"{where}: {str(value)!r} is no quantity; {_advice(kind)}.")
    number, unit = float(found[1]), found[2]
    factor = 1.0 if unit in ("", PLAIN[kind]) else KINDS[kind].get(unit)
    if factor is None:
        raise UsageError(f"{where}: {unit!r} is no unit of this quantity; {_unit(unit, kind)}.")
    size = number * factor
    if not (math.isfinite(size) and size > 0.0):
        raise UsageError(f"{where}: {value} is not a positive, finite quantity; give one.")
    return size


def _advice(kind: str) -> str:
    examples = {
        "angle": "0.1deg or 1e-3rad",
        "rate": "0.01rad/s or 0.5deg/s",
        "time": "60, 5ms or 1min",
        "ratio": "1e-6, 1ppm or 0.01%",
        "factor": "100",
    }
    return f"write it as {examples[kind]}"


def _unit(unit: str, kind: str) -> str:
    same = {known.lower(): known for known in KINDS[kind]}
    return f"write {same[unit.lower()]}" if unit.lower() in same else nearest(unit, KINDS[kind])
