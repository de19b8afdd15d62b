"""A trace judged: everything that is found of it, before it is told."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from omegadot.harness.plan import Case
from omegadot.harness.rows import Row
from omegadot.harness.score.beside import ExactCourse, exact_course, truth_beside
from omegadot.harness.score.bounds import Rounding, digits_open, joined, reading_bound
from omegadot.harness.score.columns import Columns
from omegadot.harness.score.convention import Convention
from omegadot.harness.score.flips import flips_of
from omegadot.harness.score.measured import Measured, measure_trace
from omegadot.harness.score.plausible import check_duration, check_units
from omegadot.harness.score.require import Requirement
from omegadot.harness.score.shift import Shift, best_shift
from omegadot.harness.score.steps import Beside, Compared, Declared, beside, declared_of
from omegadot.harness.score.table import Table
from omegadot.harness.score.trace import Trace, trace_of
from omegadot.harness.score.verdicts import Said, said_of
from omegadot.harness.truth import Truth


@dataclass(frozen=True)
class Reading:
    """A trace's file and how it is read."""

    table: Table
    columns: Columns
    how: Convention


@dataclass(frozen=True)
class Making:
    """What is declared of how the trace was made, and what is required of it."""

    scheme: str | None = None
    timestep: float | None = None
    requirements: tuple[Requirement, ...] = ()


@dataclass(frozen=True)
class Judged:
    """A trace and all that was found. bound: digits, rounding and floor together."""

    case: Case
    reading: Reading
    making: Making
    trace: Trace
    truth: Truth
    measured: Measured
    digits: Rounding
    bound: Rounding
    declared: Declared | None
    schemes: list[Beside]
    said: Mapping[str, Said]
    shift: Shift | None
    flips: list[Row]


def judge_trace(case: Case, reading: Reading, making: Making) -> Judged:
    """Read, measure and judge a trace. Raises TraceError and UsageError."""
    system, how = case.system, reading.how
    trace = trace_of(reading.table, reading.columns, how, system)
    check_duration(reading.table, trace, how, case.scenario.run.duration)
    declared = declared_of(trace, making.scheme, making.timestep)
    truth = truth_beside(system, case.initial, trace.times)
    check_units(reading.table, reading.columns, how, system, trace, truth)
    measured = measure_trace(trace, truth)
    digits = digits_open(truth, trace)
    bound = joined(digits, reading_bound(truth))
    schemes = []
    if declared is not None:
        held = Compared(truth, case.initial, trace, measured, digits, bound, declared)
        schemes = beside(held)
    course = exact_course(system, case.initial)
    shift = _shift(truth, course, trace, bound)
    said = said_of(measured, bound, declared, schemes)
    flips = flips_of(truth, course, trace, measured, bound)
    return Judged(
        case, reading, making, trace, truth, measured, digits, bound, declared, schemes, said,
        shift, flips,
    )  # fmt: skip


def _shift(truth: Truth, course: ExactCourse, trace: Trace, bound: Rounding) -> Shift | None:
    """By omega; by the attitude where no omega is given, or where it is constant."""
    system, rate = truth.yardstick.system, truth.yardstick.rate
    found = None
    if trace.angular_velocity is not None:
        found = best_shift(system, course, trace, bound["omega"], rate)
    if found is None and trace.orientation is not None:
        turned = replace(trace, angular_velocity=None)
        found = best_shift(system, course, turned, bound["attitude"], rate)
    return found
