"""Time stamps that run elsewhere than the scenario: which unit and start would make them fit."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from decimal import Decimal

import numpy as np

from omegadot.commands.score.measured import Measured
from omegadot.commands.score.settings import Reading
from omegadot.commands.score.stamps import EXACT, instant, plain
from omegadot.commands.score.table import TraceError
from omegadot.commands.score.trace import Trace
from omegadot.commands.units import UNITS
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.rotations import attitude_angle, normalize
from omegadot.reference_impl.system import Array
from omegadot.written import written

LONGEST = 20.0  # times the scenario's duration
# An epoch's stamps: s since 1970, from 1973 on to 2106; in ms, us and ns the ranges do not meet.
EPOCH = (1e8, 2.0**32)
# Wrong beyond doubt: a twentieth of the motion's size off, and twenty times nearer otherwise.
GROSS = 0.05
NEARER = 20.0
MOST_COMPARED = 60  # samples


@dataclass(frozen=True)
class Clock:
    """A unit of time, and the trace's time in s at the scenario's start, as text."""

    unit: str
    offset: str

    def options(self, reading: Reading) -> str:
        """What to pass, of what is not declared already."""
        parts = [f"--time-unit {self.unit}"] * (self.unit != reading.how.time_unit)
        own = instant(reading.how.time_offset, "")
        parts += [f"--time-offset {self.offset}"] * (instant(self.offset, "") != own)
        return " ".join(parts)

    def advice(self, reading: Reading) -> str:
        """What to do, of what is not so already: options to give, or a column's name to correct."""
        if self.unit == reading.how.time_unit or "time-unit" not in reading.named:
            return f"give {self.options(reading)}"
        rest = self.options(reading).removeprefix(f"--time-unit {self.unit}").strip()
        named = f"{reading.advice('time_unit', self.unit)} to {self.unit}"
        return f"{named}, and give {rest}" if rest else named


def clocks(reading: Reading, duration: float) -> Iterator[Clock]:
    """The clocks by which a trace lasts no longer than the scenario, the likeliest first.

    The unit is that of an epoch if there is one; else the one that spans the most.
    """
    stamps, how = reading.stamps, reading.how
    per_unit = 1.0 if stamps.dated or how.rate else UNITS["time"][how.time_unit]
    first = stamps.at(0)
    span = float(stamps.seconds[-1] - stamps.seconds[0]) / per_unit
    known = ["s"] if stamps.dated or how.rate else list(UNITS["time"])
    spans = {unit: span * UNITS["time"][unit] for unit in known}
    fitting = sorted(
        (unit for unit in known if spans[unit] <= 1.5 * duration), key=lambda u: -spans[u]
    )
    epochs = [
        u for u in fitting if EPOCH[0] <= float(first) / per_unit * UNITS["time"][u] < EPOCH[1]
    ]
    for unit in [*epochs, *(u for u in fitting if u not in epochs)]:
        ratio = EXACT.divide(Decimal(repr(UNITS["time"][unit])), Decimal(repr(per_unit)))
        start = EXACT.multiply(first, ratio)
        if start >= 0 and float(start) + spans[unit] <= LONGEST * duration:
            yield Clock(unit, "0")
        if start:
            yield Clock(unit, stamps.text(0) if stamps.dated else plain(start))


def check_duration(reading: Reading, duration: float) -> None:
    """Raise TraceError where the time stamps run far from the scenario's."""
    table, times = reading.table, reading.times
    first, end = float(times[0]), float(times[-1])
    if first < -float(reading.stamps.open[0]):
        start = reading.stamps.text(0)
        raise TraceError(
            f"{table.file}: {table.place(0)}: starts {written(-first)} s before the scenario "
            "does; give "
            f"--time-offset {start} if the motion begins there, or --from with a later time."
        )
    if end <= LONGEST * duration:
        return
    likely = [c for c in clocks(reading, duration) if _lasts(reading, c) > 0.01 * duration]
    best = next(iter(likely), None)
    advice = f"{best.advice(reading)} if the motion begins there" if best else ""
    if best and best.offset == "0":
        advice = f"looks like {best.unit}; {best.advice(reading)}"
    until = reading.stamps.text(-1) if reading.stamps.dated else f"{written(end, 15)} s"
    raise TraceError(
        f"{table.file}: runs until {until}, the scenario lasts {written(duration)} s; "
        f"{advice or 'declare the unit with --time-unit, or score it by a longer scenario'}."
    )


def _lasts(reading: Reading, clock: Clock) -> float:
    """S from the first sample to the last."""
    stamps = reading.stamps
    unit = 1.0 if stamps.dated or reading.how.rate else UNITS["time"][reading.how.time_unit]
    span = float(stamps.seconds[-1] - stamps.seconds[0])
    return span / unit * UNITS["time"][clock.unit]


def check_clock(found: Measured, reading: Reading, duration: float) -> None:
    """Raise TraceError where the trace is far off, and by another clock it is not.

    So too where it spans next to nothing of the scenario, and in another unit a good part of it:
    a wrong unit is then what is wrong first.
    """
    own = _misfit(found, found.trace, reading.times)
    if own <= GROSS:
        return
    span = float(reading.times[-1] - reading.times[0])
    for clock in clocks(reading, duration):
        if not clock.options(reading):
            continue
        changed = replace(reading.how, time_unit=clock.unit, time_offset=clock.offset)
        other = replace(reading, how=changed)
        misfit = _misfit(found, found.trace, other.times)
        lasts = _lasts(reading, clock) > 0.01 * duration
        longer = span < 1e-3 * duration and lasts
        fits = misfit < GROSS and misfit * NEARER < own
        # A trace that stands still fits any instant, which shows nothing of its clock.
        if longer or (fits and lasts and _moves(found, other.times)):
            why = "it does not fit the scenario"
            if longer:
                why = f"it lasts {written(span, 3)} s of the scenario's {written(duration)} s"
            raise TraceError(
                f"{reading.table.file}: by its time stamps {why}; {clock.advice(reading)} "
                "if the motion begins there."
            )


def _moves(found: Measured, times: Array) -> bool:
    """Whether the exact motion changes, as far as the trace gives it, over these times."""
    exact = found.trajectory(np.maximum(times, 0.0))
    if found.trace.angular_velocity is not None:
        change = norm(exact.angular_velocity - exact.angular_velocity[0])
        return bool(np.max(change) > GROSS * found.rate)
    return bool(np.max(attitude_angle(exact.orientation[:1], exact.orientation)) > GROSS)


def _misfit(found: Measured, trace: Trace, times: Array) -> float:
    """The median error of omega, or of the attitude, if these were the samples' times."""
    rows = np.unique(np.linspace(0, len(times) - 1, MOST_COMPARED).round().astype(int))
    exact = found.trajectory(np.maximum(times[rows], 0.0))
    own = trace.angular_velocity
    if own is not None:
        gaps = np.where(np.isnan(own[rows]), 0.0, own[rows] - exact.angular_velocity)
        return float(np.median(norm(gaps))) / found.rate
    if trace.orientation is not None:
        return float(
            np.median(attitude_angle(exact.orientation, normalize(trace.orientation[rows])))
        )
    return 0.0
