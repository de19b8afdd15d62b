"""Gate 5, trajectory: omega, attitude and position against the exact solution."""

from __future__ import annotations

import numpy as np

from omegadot.harness.gates.course import Course
from omegadot.harness.measures import TRAJECTORY_UNITS
from omegadot.harness.plan import Sweep
from omegadot.harness.rows import Row, within
from omegadot.harness.scales import EPS
from omegadot.harness.verdicts import Finding
from omegadot.reference_impl.system import Array

GATE = "trajectory"


def time_row(sweep: Sweep, times: Array) -> Row:
    """Whether the samples stand at the engine's own steps: n times the step, none missing."""
    expected = sweep.times
    if len(times) != len(expected):
        note = f"{len(times)} samples came back, {len(expected)} were asked for"
        return Row(GATE, "time", "sample_times", float("inf"), "s", 0.0, "fail", note)
    late = float(np.max(np.abs(times - expected)))
    return within(GATE, "time", "sample_times", late, "s", 2 * EPS * float(expected[-1]))


def rows(course: Course, findings: dict[str, Finding]) -> list[Row]:
    """The largest error per channel, and what is left of it after the declared scheme."""
    found = []
    for channel, unit in TRAJECTORY_UNITS.items():
        finding, bound = findings[channel], float(np.max(course.round_off[channel]))
        error = float(np.max(course.error[channel]))
        verdict = finding.verdict
        found.append(Row(GATE, channel, "error_max", error, unit, bound, verdict, finding.note))
        end = float(course.error[channel][-1])
        found.append(Row(GATE, channel, "error_end", end, unit))
        if channel in course.against_scheme:
            left = float(np.max(course.against_scheme[channel]))
            found.append(Row(GATE, channel, "unexplained_max", left, unit, bound))
    return found
