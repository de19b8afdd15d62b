"""Numbers and scripts made small enough to travel inside a page: gzip, then base 85."""

from __future__ import annotations

import json

import numpy as np

from omegadot.reference_impl.system import Array
from omegadot.reports.charts.chart_library import pack
from omegadot.reports.record.run_json import plain

# What a logarithmic axis cannot show, zero among it, is drawn at the floor, with a label.
FLOOR_DECADE, CEILING_DECADE = -17, 20
FLOOR = 10.0**FLOOR_DECADE
_MISSING = 0xFFFF
_LARGEST_CODE = _MISSING - 1


def rounded(value: float | None, digits: int = 4) -> float | None:
    """A number to so many significant digits: what a picture shows, in few characters."""
    return None if value is None else float(f"{value:.{digits}g}")


def pack_json(value: object) -> str:
    """`pack` of the value as compact, strict JSON."""
    return pack(json.dumps(plain(value), separators=(",", ":"), allow_nan=False).encode())


def codes_of(values: Array) -> Array:
    """Magnitudes as 16-bit logarithms, to 0.07 %: 0 at or below the floor, 65535 for no number.

    ``code = 1 + round(65533 (log10 v - floor) / (ceiling - floor))``, ended at the ceiling.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        decades = np.log10(np.abs(values))
    share = (decades - FLOOR_DECADE) / (CEILING_DECADE - FLOOR_DECADE)
    codes = 1 + np.rint((_LARGEST_CODE - 1) * np.nan_to_num(share, posinf=1.0, neginf=-1.0))
    codes = np.where(np.abs(values) <= FLOOR, 0, np.clip(codes, 0, _LARGEST_CODE))
    return np.where(np.isnan(values), _MISSING, codes).astype(np.uint16)


def pack_codes(codes: Array) -> str:
    """16-bit codes as differences, their high bytes first and their low bytes after: small.

    Read back: code = (sum of differences so far) modulo 65536.
    """
    differences = np.diff(codes.astype(np.int64), prepend=0).astype(np.uint16)
    high, low = (differences >> 8).astype(np.uint8), (differences & 0xFF).astype(np.uint8)
    return pack(high.tobytes() + low.tobytes())
