"""A trace judged: everything that is found of it, before it is reported."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from omegadot.commands.score.bounds import Rounding, digits_open, joined, reading_bound
from omegadot.commands.score.exact_trajectory import ExactTrajectory, exact_trajectory, truth_at
from omegadot.commands.score.measured import Measured, flips_of, measure_trace
from omegadot.commands.score.plausible import check_duration, check_units
from omegadot.commands.score.require import Requirement
from omegadot.commands.score.settings import Reading
from omegadot.commands.score.shift import Shift, best_shift
from omegadot.commands.score.steps import (
    Compared,
    Comparison,
    Declared,
    compare_schemes,
    declared_of,
)
from omegadot.commands.score.trace import Trace, trace_of
from omegadot.commands.score.verdicts import Judgement, judgement_of
from omegadot.gates.case import Case
from omegadot.gates.rows import Row
from omegadot.gates.truth import Truth


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
    schemes: list[Comparison]
    judgement: Mapping[str, Judgement]
    shift: Shift | None
    flips: list[Row]


def judge_trace(case: Case, reading: Reading, making: Making) -> Judged:
    """Read, measure and judge a trace. Raises TraceError and UsageError."""
    system, how = case.system, reading.how
    trace = trace_of(reading.table, reading.columns, how, system)
    check_duration(reading.table, trace, how, case.scenario.run.duration)
    declared = declared_of(trace, making.scheme, making.timestep)
    truth = truth_at(system, case.initial, trace.times)
    check_units(reading.table, reading.columns, how, system, trace, truth)
    measured = measure_trace(trace, truth)
    digits = digits_open(truth, trace)
    bound = joined(digits, reading_bound(truth))
    schemes = []
    if declared is not None:
        held = Compared(truth, case.initial, trace, measured, digits, bound, declared)
        schemes = compare_schemes(held)
    trajectory = exact_trajectory(system, case.initial)
    shift = _shift(truth, trajectory, trace, bound)
    judgement = judgement_of(measured, bound, declared, schemes)
    flips = flips_of(truth, trajectory, trace, measured, bound)
    return Judged(
        case, reading, making, trace, truth, measured, digits, bound, declared, schemes, judgement,
        shift, flips,
    )  # fmt: skip


def _shift(
    truth: Truth, trajectory: ExactTrajectory, trace: Trace, bound: Rounding
) -> Shift | None:
    """By omega; by the attitude where no omega is given, or where it is constant."""
    system, rate = truth.yardstick.system, truth.yardstick.rate
    found = None
    if trace.angular_velocity is not None:
        found = best_shift(system, trajectory, trace, bound["omega"], rate)
    if found is None and trace.orientation is not None:
        turned = replace(trace, angular_velocity=None)
        found = best_shift(system, trajectory, turned, bound["attitude"], rate)
    return found
