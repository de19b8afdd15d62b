"""Causes in the times of a run: samples missing, and clocks that are late, coarse or too fast."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from omegadot.diagnosis.reported.clock_roundings import roundings_of
from omegadot.diagnosis.wording.digits import factor, number
from omegadot.gates.case import Sweep
from omegadot.gates.runs.trajectory import clock_rounding
from omegadot.reference_impl.system import Array
from omegadot.written import written

UNITS = {1e3: "milliseconds", 1e6: "microseconds", 1e9: "nanoseconds"}
GRIDS = {1e-3: "milliseconds", 1e-6: "microseconds", 1e-9: "nanoseconds"}
SAME = 1e-9  # relative, of a factor that is looked for
WHOLE_INTERVAL = (
    "the last time is a whole interval after the one before, though fewer steps lead to it"
)
COARSE = ("times are off by", "the times are whole")
FACTORS = ("every time is too", "every time is scaled by")
EPS_SINGLE = float(np.finfo(np.float32).eps)


def clock_of_runs(
    runs: Sequence[tuple[Array, Sweep]], failed: Sequence[int], eps: float
) -> tuple[str, ...]:
    """What is wrong with the clock of the runs of one integrator on a scenario; () where nothing.

    runs: times as reported.  failed: the places of those that fail a gate. A factor is one of every
    run, and so is a rounding; after it what is seen of the first of these, which holds where
    another scenario has none.
    """
    for place in failed:
        text = clock_cause(*runs[place], eps)
        if text.startswith(FACTORS):
            (time, sweep), ratio = runs[place], _ratio(*runs[place])
            same = all(_goes_by(ratio, *run, eps) for run in runs)
            return (*[text] * same, _off(time - sweep.times, sweep))
        if text:
            coarse = text.startswith(COARSE)
            return (*(roundings_of(runs, eps) if coarse else ()), text)
    return ()


def clock_cause(time: Array, sweep: Sweep, eps: float) -> str:
    """What is wrong with the times of a run; "" where they are right, to the gate's own bound."""
    expected = sweep.times
    if len(time) != len(expected):
        return _samples(time, expected)
    tolerance = clock_rounding(sweep, eps)
    late = time - expected
    if not np.isfinite(time).all():
        return "times are reported that are not finite"
    if len(time) > 2 and np.all(np.abs(time - expected[::-1]) <= tolerance):
        return "the samples come in the opposite order, the last one first"
    if np.all(np.abs(late) <= tolerance):
        return ""
    if abs(late[0]) > tolerance and np.all(np.abs(late - late[0]) <= 2.0 * tolerance):
        size, when = abs(float(late[0])), "late" if late[0] > 0.0 else "early"
        steps = np.float64(size) / sweep.timestep if size < sweep.times[-1] else np.inf
        counted = f", {written(steps, 3)} steps" if np.isfinite(steps) else ""
        return f"every time is reported {written(size, 4)} s {when}{counted}"
    # sums in single precision may be in proportion over a few steps
    found = _in_single(time, sweep) or _in_proportion(time, sweep, eps)
    return found or _rounded(time, expected) or _off(late, sweep)


def _samples(time: Array, expected: Array) -> str:
    missing = len(expected) - len(time)
    counted = "sample is" if missing == 1 else f"{missing} samples are"
    for which, left in (("first", expected[missing:]), ("last", expected[:-missing])):
        if missing > 0 and np.allclose(time, left, rtol=1e-12, atol=0.0):
            return f"the {which} {counted} missing"
    return f"{len(time)} samples came back, {len(expected)} were requested"


def _ratio(time: Array, sweep: Sweep) -> float:
    return float(time[-1] / sweep.times[-1])


def _goes_by(ratio: float, time: Array, sweep: Sweep, eps: float) -> bool:
    """Whether all times are by this factor off, to the gate's own bound."""
    expected = sweep.times
    if len(time) != len(expected):
        return False
    tolerance = 4.0 * max(ratio, 1.0) * eps * float(expected[-1])
    return bool(np.all(np.abs(time - ratio * expected) <= tolerance))


def _in_proportion(time: Array, sweep: Sweep, eps: float) -> str:
    ratio = _ratio(time, sweep)
    if not _goes_by(ratio, time, sweep, eps):
        return ""
    for k, unit in UNITS.items():
        if abs(ratio / k - 1.0) < SAME:
            return f"the times are reported in {unit}"
    if abs(ratio - 1.0) > 0.1:
        return f"every time is scaled by {factor(ratio)}"
    wrong = "small" if ratio < 1.0 else "large"
    return f"every time is too {wrong}, by {written(abs(ratio - 1.0), 3)} of it"


def _in_single(time: Array, sweep: Sweep) -> str:
    """Every time is a single, and as near as the sum of so many rounded steps is."""
    expected = sweep.times
    with np.errstate(over="ignore"):
        rounded = [values.astype(np.float32).astype(float) for values in (time, expected)]
    near = np.abs(time - expected) <= EPS_SINGLE * np.maximum(1, sweep.sample_steps) * expected
    if np.array_equal(time, rounded[0]) and np.any(expected != rounded[1]) and np.all(near):
        return "the times are kept in single precision"
    return ""


def _rounded(time: Array, expected: Array) -> str:
    if np.max(np.abs(time)) > np.finfo(np.float32).max:
        return ""  # no single holds it, and no rounding leads there
    for grid, unit in GRIDS.items():
        whole = time / grid
        near = np.abs(whole - np.round(whole)) <= 1e-6 * np.maximum(1.0, np.abs(whole) * 1e-9)
        due = np.abs(expected / grid - np.round(expected / grid))
        if np.all(due <= 1e-6 * np.maximum(1.0, np.abs(whole) * 1e-9)):
            continue  # the right ones are as well
        if np.all(near) and np.all(np.abs(time - expected) <= 1.01 * grid):
            return f"the times are whole {unit}: what is left of them is cut off or rounded"
    return ""


def _off(late: Array, sweep: Sweep) -> str:
    """Which times are off, where nothing more is known."""
    wrong = np.flatnonzero(np.abs(late) > clock_rounding(sweep))
    if len(wrong) == 1:
        place, which = int(wrong[0]), "the last time"
        if place < len(late) - 1:
            which = f"one time, that of sample {place},"
        due, came = float(sweep.times[place]), float(sweep.times[place] + late[place])
        whole = place * sweep.every * sweep.timestep
        if place == len(late) - 1 and abs(came - whole) <= clock_rounding(sweep):
            return WHOLE_INTERVAL
        near = came if abs(came - due) < due else None  # far from it, no more digits are needed
        return f"{which} alone is off: {number(came, due)} s, where {number(due, near)} s was due"
    largest = float(np.max(np.abs(late)))
    return f"times are off by up to {written(largest, 3)} s, from sample {int(wrong[0])} on"
