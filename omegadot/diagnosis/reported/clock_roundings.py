"""Clocks that are rounded or cut off: to significant digits, to decimals, to ticks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from omegadot.gates.case import Sweep
from omegadot.reference_impl.system import Array

MOST_DIGITS, MOST_DECIMALS = 12, 12
TICKS = (24, 25, 30, 50, 60, 64, 75, 90, 120, 128, 240, 250, 256, 300, 500, 512, 600, 1024, 90000)
LEAST = 3  # times that are others
UNITS = {0: "whole seconds", 3: "milliseconds", 6: "microseconds", 9: "nanoseconds"}
ON_GRID = 1e-6  # of a unit, beside the rounding of the number itself
Clock = tuple[str, Array, Array]  # as text, units (n,) s, and from how much below to above in units


def roundings_of(runs: Sequence[tuple[Array, Sweep]], eps: float) -> list[str]:
    """Each rounding that makes the times of all runs of those that are due.

    A time is a whole number of units, and nearest to the one that is due, or the last before it.
    The unit of significant digits goes with the time, and the others are the same everywhere.
    """
    if any(len(time) != len(sweep.times) for time, sweep in runs):
        return []
    time = np.concatenate([time for time, _ in runs])
    due = np.concatenate([sweep.times for _, sweep in runs])
    known = np.concatenate([np.full(len(time), sweep.times[-1]) for time, sweep in runs])
    tolerance = 2.0 * eps * known  # the gate's own
    if np.count_nonzero(np.abs(time - due) > tolerance) < LEAST or not np.all(np.isfinite(time)):
        return []
    return [text for text, *units in _clocks(due) if _is_made(time, due, tolerance, *units)]


def _clocks(due: Array) -> Iterator[Clock]:
    nearest, before = np.array([-0.5, 0.5]), np.array([-1.0, 0.0])
    places = np.floor(np.log10(np.where(due > 0.0, due, 1.0)))
    for digits in range(1, MOST_DIGITS + 1):
        many = f"{digits} significant digit{'s' * (digits > 1)}"
        yield f"the clock is rounded to {many}", 10.0 ** (places - digits + 1), nearest
        yield f"the clock is cut off to {many}", 10.0 ** (places - digits + 1), before
    decimals = {n: UNITS.get(n, f"{n} decimal{'s' * (n > 1)}") for n in range(MOST_DECIMALS + 1)}
    fixed = {text: 10.0**-n for n, text in decimals.items()}
    fixed |= {f"ticks of 1/{ticks} s": 1.0 / ticks for ticks in TICKS}
    for text, unit in fixed.items():
        yield f"the clock is rounded to {text}", np.full(len(due), unit), nearest
        yield f"the clock is cut off to {text}", np.full(len(due), unit), before


def _is_made(time: Array, due: Array, tolerance: Array, unit: Array, ends: Array) -> bool:
    left = ON_GRID + tolerance / unit
    off, whole = (time - due) / unit, np.round(time / unit)
    on_grid = np.abs(time / unit - whole) <= left
    between = (off >= ends[0] - left) & (off <= ends[1] + left)
    # where the unit is not seen for the rounding of the number, anything is a whole number of them
    return bool(np.all(on_grid & between) and np.all(left < 0.1))
