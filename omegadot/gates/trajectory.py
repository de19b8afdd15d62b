"""Gate 5, trajectory: omega, attitude and position against the exact solution."""

from __future__ import annotations

import numpy as np

from omegadot.gates.case import Sweep
from omegadot.gates.measured_run import MeasuredRun
from omegadot.gates.measures import TRAJECTORY_UNITS
from omegadot.gates.rows import Row, within
from omegadot.gates.scales import EPS
from omegadot.gates.verdicts import Finding
from omegadot.reference_impl.system import Array

GATE = "trajectory"


def time_row(sweep: Sweep, times: Array) -> Row:
    """Whether the samples stand at the engine's own steps: n times the step, none missing."""
    expected = sweep.times
    if len(times) != len(expected):
        note = f"{len(times)} samples came back, {len(expected)} were requested"
        return Row(GATE, "time", "sample_times", float("inf"), "s", 0.0, "fail", note)
    late = float(np.max(np.abs(times - expected)))
    return within(GATE, "time", "sample_times", late, "s", 2 * EPS * float(expected[-1]))


def rows(measured: MeasuredRun, findings: dict[str, Finding]) -> list[Row]:
    """The largest error per channel, and what is left of it after the declared scheme."""
    found = []
    for channel, unit in TRAJECTORY_UNITS.items():
        finding, bound = findings[channel], float(np.max(measured.round_off[channel]))
        error = float(np.max(measured.error[channel]))
        verdict = finding.verdict
        found.append(Row(GATE, channel, "error_max", error, unit, bound, verdict, finding.note))
        end = float(measured.error[channel][-1])
        found.append(Row(GATE, channel, "error_end", end, unit))
        if channel in measured.against_scheme:
            left = float(np.max(measured.against_scheme[channel]))
            found.append(Row(GATE, channel, "unexplained_max", left, unit, bound))
    return found
