"""Units that were declared wrongly, recognised by the numbers."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from omegadot.commands.score.clock import GROSS, NEARER
from omegadot.commands.score.columns import GROUPS
from omegadot.commands.score.measured import Measured, measure_trace
from omegadot.commands.score.settings import Reading
from omegadot.commands.score.table import TraceError
from omegadot.commands.score.trace import trace_of
from omegadot.commands.units import UNITS
from omegadot.gates.bounds.scales import norm
from omegadot.written import written

# The motion has moved by then, and an error of the simulator's has not grown large.
FIRST = 0.25


def check_units(found: Measured, reading: Reading) -> None:
    """Raise TraceError where another unit than the declared one fits, and that one does not."""
    for kind, (group, channel, what) in _SIGNS.items():
        units, field = UNITS[kind], f"{kind}_unit"
        given_roles = set(GROUPS[group]) & set(reading.columns)
        if not given_roles or channel not in found.error or _misfit(found, channel) <= GROSS:
            continue
        given = getattr(reading.how, field)
        for unit in units:
            changed: dict[str, Any] = {field: unit}
            other = replace(reading, how=replace(reading.how, **changed))
            trace = trace_of(other, found.case.system)
            misfit = _misfit(measure_trace(found.case, trace, found.truth), channel)
            if misfit * NEARER < _misfit(found, channel) and misfit < GROSS:
                factor = units[given] / units[unit]
                times = (
                    f"{written(factor, 3)} times"
                    if factor >= 1.0
                    else f"1/{written(1.0 / factor, 3)} of"
                )
                raise TraceError(
                    f"{reading.table.file}: {what} {times} what {given} would give here, and looks "
                    f"like {unit}; {reading.advice(field, unit)}."
                )
    _check_one_rate(found, reading)


def _check_one_rate(found: Measured, reading: Reading) -> None:
    """Raise TraceError where one component of omega is in another unit than the others, which fit.

    In its first part, within GROSS of the motion's rate: the factor is that of two units.
    """
    came, due = found.trace.angular_velocity, found.truth.state.angular_velocity
    if came is None:
        return
    rows = slice(0, max(3, int(FIRST * len(found.trace.times))))
    size = float(np.median(norm(due[rows])))
    gaps = np.median(np.abs(came - due)[rows], axis=0)
    wrong = np.flatnonzero(~(gaps <= GROSS * size / NEARER))
    if len(wrong) != 1 or not np.all(np.isfinite(came)):
        return
    k, units, given = int(wrong[0]), UNITS["rate"], reading.how.rate_unit
    for unit in units:
        factor = units[given] / units[unit]
        gap = float(np.median(np.abs(came[rows, k] / factor - due[rows, k])))
        if gap <= GROSS * size / NEARER and gap * NEARER < gaps[k]:
            role = "w" + "xyz"[k]
            name = reading.columns.get(role, role)
            raise TraceError(
                f"{reading.table.file}: column {name!r} is {written(factor, 3)} times what {given} "
                f"would give here, and looks like {unit}, where the other components of omega are "
                f"in {given}; convert it to {given}."
            )


# By the kind of a unit: a group of columns and a channel that show it.
_SIGNS = {
    "rate": ("w", "omega", "the angular velocity is"),
    "angle": ("e", "attitude", "the angles are"),
    "length": ("p", "position", "the positions are"),
}


def _misfit(found: Measured, channel: str) -> float:
    """The median error over the first part, relative to the motion's size (an angle to 1 rad)."""
    rows = slice(0, max(3, int(FIRST * len(found.trace.times))))
    gap, size = float(np.median(found.error[channel][rows])), 1.0
    if channel == "position":
        size = float(np.median(norm(found.truth.state.position[rows])))
    return gap / size if size > 0.0 else 0.0
