"""Every way in which a trace's time stamps may be read."""

from __future__ import annotations

from decimal import Decimal
from typing import Any

import numpy as np
from numpy.typing import NDArray

from omegadot.commands.score.clock import LONGEST
from omegadot.commands.score.detection.reading import Clock
from omegadot.commands.score.stamps import (
    Stamps,
    check_rising,
    counted,
    in_window,
    instant,
    plain,
    stamps_of,
)
from omegadot.commands.score.table import Table, TraceError
from omegadot.commands.units import UNITS
from omegadot.reference_impl.system import Array

Timed = tuple[Clock, NDArray[np.bool_], Array]
"""A clock, which of the samples are in the window, and their times since the start."""


def clocks_of(
    table: Table, column: str | None, declared: dict[str, Any], duration: float
) -> list[Timed]:
    """Every way to read the times: which samples are in the window, and (n,) s since the start."""
    options = tuple(declared.items())
    first, last = (
        instant(declared[key], f"--{key}") if key in declared else None for key in ("from", "to")
    )
    found: list[Timed] = []
    for unit, scale in UNITS["time"].items():
        inside = in_window(_stamps(table, column, scale, declared), first, last)
        if np.sum(inside) < 3:
            continue
        part = table.part(inside)
        stamps = _stamps(part, column, scale, declared)
        check_rising(part, stamps)
        start, span = stamps.at(0), float(stamps.seconds[-1] - stamps.seconds[0])
        if 0.0 < span <= LONGEST * duration:
            offsets = [Decimal(0)] * (0.0 <= float(start) <= LONGEST * duration)
            for offset in [*offsets, *([start] if start else [])]:
                clock = Clock(column, unit, _written(offset), options)
                found.append((clock, inside, stamps.since(offset)))
        if stamps.dated or column is None:
            break
    if not found and len(table) < 3:
        raise TraceError(f"{table.file}: fewer than three samples; give more.")
    return found


def _stamps(table: Table, column: str | None, scale: float, declared: dict[str, Any]) -> Stamps:
    if column is None:
        return counted(table, float(declared["rate"]))
    return stamps_of(table, column, scale)


def _written(offset: Decimal) -> float | str:
    """As a float, where that has all the digits."""
    return float(offset) if Decimal(repr(float(offset))) == offset else plain(offset)
