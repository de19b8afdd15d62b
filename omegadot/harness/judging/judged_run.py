"""One run of an integrator, judged: its outcome, its rows and its reason."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from omegadot.adapters.protocol import Integrator
from omegadot.gates.bounds.measures import TRAJECTORY_UNITS
from omegadot.gates.case import Sweep
from omegadot.gates.errors.measured_run import STATE, MeasuredRun
from omegadot.gates.errors.verdicts import Finding
from omegadot.gates.rows import Row
from omegadot.gates.runs import cost, invariants, phase, trajectory
from omegadot.gates.truth import Truth
from omegadot.harness.drive import CaseResult
from omegadot.harness.judging.engine import held
from omegadot.reference_impl.system import State
from omegadot.workers.harness_end.process import Answer
from omegadot.written import written

# In the order of a state's fields.
STATE_CHANNELS = ("attitude", "omega", "position", "linear_momentum")
Run = TypeVar("Run", bound=MeasuredRun)


@dataclass(frozen=True)
class JudgedRun:
    """One task's outcome, rows and reason.

    unresolved: a finer sweep could still decide.  finer: that sweep, where it is not half the step.
    by_axes: the axes of the world could still decide whether a long step errs by its coordinates.
    """

    integrator: Integrator
    sweep: Sweep
    outcome: str
    reason: str
    rows: list[Row] = field(default_factory=list)
    why: str = ""
    unresolved: bool = False
    finer: Sweep | None = None
    by_axes: bool = False

    @property
    def fails(self) -> bool:
        """Whether a gate fails on it."""
        return any(row.verdict == "fail" for row in self.rows)


def is_finite(state: State) -> bool:
    """Whether every number of a trajectory is finite."""
    return all(bool(np.all(np.isfinite(values))) for values in vars(state).values())


# From the least favourable.
_FINDINGS = (
    *("unexplained", "outlying", "unsettled", "unresolved", "beyond"),
    *("consistent", "explained", "round-off"),
)


def why_of(findings: dict[str, Finding]) -> str:
    """One reason for the whole run: the least favourable among its channels."""
    channel = min(findings, key=lambda c: _FINDINGS.index(findings[c].kind))
    finding = findings[channel]
    alone = finding.kind in ("explained", "round-off", "beyond")
    return finding.note if alone else f"{channel}: {finding.note}"


def measured_runs_of(
    measured: Callable[[Sweep, State], Run], answers: Iterable[tuple[Sweep, Answer]]
) -> dict[Sweep, Run]:
    """The runs of one integrator that can be measured: those with the samples requested."""
    return {
        sweep: measured(sweep, State(**answer.result["state"]))
        for sweep, answer in answers
        if answer.ok and len(answer.result["time"]) == len(sweep.times)
    }


def _finite(state: State) -> dict[str, NDArray[np.bool_]]:
    """(n,) by channel: where the quantity that it is of is finite."""
    fields = zip(STATE_CHANNELS, vars(state).values(), strict=True)
    return {channel: np.isfinite(values).all(-1) for channel, values in fields}


def _unbounded_row(state: State, verdict: str, note: str) -> Row:
    """Of the first quantity that is not finite: of omega, where several cease to be at once."""
    finite = _finite(state)
    begins = {c: int(np.argmin(ok)) if not ok.all() else len(ok) for c, ok in finite.items()}
    channel = min(("omega", *STATE_CHANNELS), key=lambda c: begins[c])
    unit = TRAJECTORY_UNITS.get(channel, "1")
    return Row("trajectory", channel, "error_max", float("nan"), unit, None, verdict, note)


def diverged(
    integrator: Integrator,
    sweep: Sweep,
    answer: Answer,
    measured: MeasuredRun,
    findings: dict[str, Finding],
    eps: float,
) -> JudgedRun:
    """A run whose state ceases to be finite; what its scheme does as well is not judged.

    Energy and angular momentum follow from the state, and overflow before it.
    """
    finite = np.isfinite(measured.saturating_error) & np.isfinite(answer.result["time"])
    finite &= np.all(list(_finite(State(**answer.result["state"])).values()), axis=0)
    bad = np.flatnonzero(~finite)
    when = f" from t = {written(sweep.times[bad[0]])} s" if len(bad) else ""
    note = f"the state is not finite{when}"
    of_state = [finding for channel, finding in findings.items() if channel in STATE]
    worst = min(of_state, key=lambda f: _FINDINGS.index(f.kind))
    rows = [
        trajectory.time_row(sweep, answer.result["time"], eps),
        _unbounded_row(State(**answer.result["state"]), worst.verdict, worst.note),
    ]
    why = note if worst.verdict == "fail" else worst.note
    return JudgedRun(integrator, sweep, "diverged", note, rows, why, worst.open)


def failed(integrator: Integrator, sweep: Sweep, answer: Answer, eps: float) -> JudgedRun:
    """A task without a trajectory to measure: its outcome, and the verdict on its times."""
    if not answer.ok:
        return JudgedRun(integrator, sweep, answer.outcome, answer.reason)
    rows = [trajectory.time_row(sweep, answer.result["time"], eps)]
    if is_finite(State(**answer.result["state"])):
        return JudgedRun(integrator, sweep, "ok", "", rows, why=rows[0].note)
    note = "the state is not finite"
    rows.append(_unbounded_row(State(**answer.result["state"]), "fail", note))
    return JudgedRun(integrator, sweep, "diverged", note, rows, why=note)


def rows_of_run(
    truth: Truth,
    measured: MeasuredRun,
    findings: dict[str, Finding],
    answer: Answer,
    result: CaseResult,
) -> tuple[list[Row], list[str]]:
    """The rows of one run, whatever its knob, and the notes of what it misreports."""
    system, eps = truth.yardstick.system, truth.yardstick.eps
    state, sweep = State(**answer.result["state"]), measured.sweep
    misreported = trajectory.reported_rows(truth, measured, state, result.precision)
    omega_dot = trajectory.omega_dot_rows(system, state, answer.result["omega_dot"], eps)
    misreported += held(result, omega_dot)
    rows = invariants.rows(measured, findings, sweep.times)
    rows.append(trajectory.time_row(sweep, answer.result["time"], eps))
    rows += [*misreported, *trajectory.rows(measured, findings)]
    rows += phase.rows(truth, measured, state)
    rows += cost.rows(sweep, answer.result["seconds_per_step"])
    return rows, [row.note for row in misreported if row.verdict == "fail"]
