"""A trace judged: everything that is found of it, before it is reported."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from omegadot.commands.score.attitude import of_matrix
from omegadot.commands.score.causes import causes_of_trace
from omegadot.commands.score.clock import check_clock, check_duration
from omegadot.commands.score.declared import Declared, declared_of
from omegadot.commands.score.exact_trajectory import truth_at
from omegadot.commands.score.held import Held, held_channels
from omegadot.commands.score.measured import Measured, flips_of, measure_trace
from omegadot.commands.score.plausible import check_units
from omegadot.commands.score.settings import Reading
from omegadot.commands.score.shift import Shift, shift_of
from omegadot.commands.score.steps import (
    Compared,
    Comparison,
    compare_schemes,
)
from omegadot.commands.score.trace import trace_of
from omegadot.commands.score.world import Shifted, Turned, shifted_world, turned_world
from omegadot.gates.bounds.measures import INVARIANT_CHANNELS, TRAJECTORY_UNITS
from omegadot.gates.case import Case
from omegadot.gates.errors.measured_run import CHANNELS
from omegadot.gates.errors.verdicts import Finding
from omegadot.gates.rows import Row
from omegadot.harness.usage import UsageError
from omegadot.reference_impl.flight.euler_angles import Angles
from omegadot.reference_impl.solutions.representable import UnrepresentableError
from omegadot.reference_impl.system import Array
from omegadot.written import written

GATES = {c: "invariants" if c in INVARIANT_CHANNELS else "trajectory" for c in CHANNELS}
UNITS = {"omega": "rad/s", "attitude": "rad", "position": "m"}


@dataclass(frozen=True)
class Judgement:
    """A channel judged. verdict: pass, fail or info. kind: as in `Finding`, or ``measured``."""

    kind: str
    verdict: str
    note: str


@dataclass(frozen=True)
class ChannelScore:
    """A channel's error against the exact solution, in `unit`; "1" is relative.

    max, end, rms, start: of the samples.  digits_open: the resolution of the data, by its digits.
    bound: that, rounding and the floor together.  verdict: pass, fail or info, with kind and note.
    """

    max: float
    end: float
    rms: float
    start: float
    digits_open: float
    bound: float
    unit: str
    verdict: str
    kind: str
    note: str


@dataclass(frozen=True)
class Judged(Measured):
    """A trace and all that was found."""

    reading: Reading
    declared: Declared | None
    compared: Compared
    judgement: Mapping[str, Judgement]
    shift: Shift | None
    flips: list[Row]
    turned: Turned | None
    shifted: Shifted | None
    held: list[Held]
    causes: list[str]

    @property
    def scheme(self) -> str | None:
        """The scheme that is declared."""
        return self.declared.scheme if self.declared else None

    @property
    def own(self) -> Comparison | None:
        """The comparison with the scheme that is declared."""
        return self.compared.schemes[0] if self.scheme is not None else None

    def nearest(self, channel: str) -> Comparison | None:
        """The scheme that leaves the least of a channel's error, where that is next to nothing."""
        near = [one for one in self.compared.schemes if one.near(channel, self.error[channel])]
        return min(near, key=lambda one: float(np.max(one.left[channel])), default=None)

    def in_si(self, channel: str) -> ChannelScore:
        """One channel, in SI units."""
        factor = self.rate if channel == "omega" else 1.0
        return self.score(channel, factor, UNITS.get(channel, "1"))

    def score(self, channel: str, factor: float, unit: str) -> ChannelScore:
        """One channel, in a unit that is 1 / factor of the yardstick's."""
        error = self.error[channel]
        return ChannelScore(
            max=factor * float(np.max(error)),
            end=factor * float(error[-1]),
            rms=factor * math.sqrt(float(np.mean(error**2))),
            start=factor * float(error[0]),
            digits_open=factor * float(np.max(self.digits[channel])),
            bound=factor * float(np.max(self.bound[channel])),
            unit=unit,
            **vars(self.judgement[channel]),
        )


def judge_trace(
    case: Case, reading: Reading, scheme: str | None = None, timestep: float | None = None
) -> Judged:
    """Read, measure and judge a trace, with what is declared of how it was made.

    Raises TraceError and UsageError.
    """
    trace = trace_of(reading, case.system)
    check_duration(reading, case.scenario.run.duration)
    trace, declared = declared_of(trace, scheme, timestep, _angles(reading))
    try:
        truth = truth_at(case.system, case.initial, trace.times)
    except UnrepresentableError as error:
        why = f"the exact trajectory cannot be worked out: {error}"
        raise UsageError(f"{case.name}: {why}; give numbers within that range.") from None
    measured = measure_trace(case, trace, truth)
    check_units(measured, reading)
    check_clock(measured, reading, case.scenario.run.duration)
    compared = Compared([]) if declared is None else compare_schemes(measured, declared)
    shift = shift_of(measured)
    turned, shifted = turned_world(measured, shift), shifted_world(measured)
    explained = bool(shift and shift.explains) or turned is not None or shifted is not None
    explained = explained or any(one.agrees("omega") for one in compared.schemes)
    return Judged(
        **vars(measured),
        reading=reading,
        declared=declared,
        compared=compared,
        judgement=_judgements(measured, declared, compared.schemes),
        shift=shift,
        flips=flips_of(measured),
        turned=turned,
        shifted=shifted,
        held=held_channels(measured, reading),
        causes=[] if explained else causes_of_trace(measured),
    )


def _angles(reading: Reading) -> Angles:
    """The Euler angles that the trace's simulator may have stepped: those of the trace, or ZYX."""
    how = reading.how
    world, body = (
        None if np.array_equal(axes, np.eye(3)) else of_matrix(axes)
        for axes in (how.world_axes, how.body_axes)
    )
    stepped = "e1" in reading.columns and how.attitude_is == "world-from-body"
    if not stepped:
        return Angles("ZYX", world, body)
    intrinsic = how.euler if how.euler.isupper() else how.euler.upper()[::-1]
    return Angles(intrinsic, world, body)


def _finding(error: Array, bound: Array, own: Comparison | None, channel: str) -> Finding:
    if np.all(error <= bound):
        return Finding("round-off", "within digits and rounding")
    if own is not None:
        unit = TRAJECTORY_UNITS.get(channel, "1")
        left = (
            f"{written(float(np.max(own.left[channel])), 2)} {'relative' if unit == '1' else unit}"
        )
        if own.agrees(channel):
            return Finding("explained", f"explained by {own.scheme}, to {left}")
        return Finding("unexplained", f"not explained by {own.scheme}: {left} is left")
    return Finding("beyond", "measured, not judged: no scheme is declared")


def _judgements(
    measured: Measured, declared: Declared | None, schemes: list[Comparison]
) -> dict[str, Judgement]:
    """Every given channel judged.

    Nothing is green by halves: without a declared scheme a gate passes only where all of its
    channels are within what digits and rounding leave open.
    """
    own = schemes[0] if declared and declared.scheme is not None else None
    findings = {}
    for channel, error in measured.error.items():
        agreeing = next((one for one in schemes if one.agrees(channel)), None)
        findings[channel] = _finding(error, measured.bound[channel], own or agreeing, channel)
    found = {}
    for channel, finding in findings.items():
        verdict, note = finding.verdict, finding.note
        if own is not None and own.own_start and finding.kind == "explained":
            verdict, note = "info", f"{note}, from its own start"
        elif own is None and verdict != "info":
            alike = [f for c, f in findings.items() if GATES[c] == GATES[channel]]
            whole = all(f.kind == "round-off" for f in alike)
            verdict = "pass" if whole else "info"
            note += " (not declared)" if finding.kind == "explained" else ""
        remark = measured.remarks.get(channel)
        found[channel] = Judgement(finding.kind, verdict, f"{note}; {remark}" if remark else note)
    return found
