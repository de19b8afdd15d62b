"""Gate 5, trajectory: omega, attitude and position against the exact solution.

A run also reports what the contract requires, whatever the scheme and its order: it begins at the
state that it was given, its quaternions are of unit length, and an engine that works in double
precision reports numbers of double precision. No step size excuses any of these.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.gates.bounds.measures import TRAJECTORY_UNITS
from omegadot.gates.bounds.scales import EPS, ROUNDINGS_PER_STEP, norm
from omegadot.gates.case import Sweep
from omegadot.gates.errors.measured_run import MeasuredRun
from omegadot.gates.errors.verdicts import Finding
from omegadot.gates.rows import Row, within
from omegadot.gates.states import equation
from omegadot.gates.truth import Truth
from omegadot.reference_impl.system import Array, State, System
from omegadot.written import written

GATE = "trajectory"
DIGITS, SINGLE_DIGITS = 53, 24  # of a double's and of a single's mantissa
FINEST = -1074  # every double is a whole multiple of 2 to this power
FEWEST_COARSE = 8  # by chance one in 4^8 = 65 536


def time_row(sweep: Sweep, times: Array, eps: float = EPS) -> Row:
    """Whether the samples stand at the engine's own steps: n times the step, none missing.

    See `clock_rounding` for what a clock may be off by.
    """
    expected = sweep.times
    if len(times) != len(expected):
        note = f"{len(times)} samples came back, {len(expected)} were requested"
        return Row(GATE, "time", "sample_times", float("inf"), "s", 0.0, "fail", note)
    late = float(np.max(np.abs(times - expected)))
    return within(GATE, "time", "sample_times", late, "s", clock_rounding(sweep, eps))


def clock_rounding(sweep: Sweep, eps: float = EPS) -> float:
    """s, what rounding may make of the last time T of a run of n steps: ``max(2, 1 + n/4) eps T``.

    A clock that is n times the step rounds the step and the product. One that is a running sum
    rounds each time ``k h`` by half an eps of it: ``sum (eps/2) k h = (n + 1) eps T / 4``.
    """
    return max(2.0, 1.0 + 0.25 * sweep.steps) * eps * float(sweep.times[-1])


def rows(measured: MeasuredRun, findings: dict[str, Finding]) -> list[Row]:
    """The largest error per channel, and what is left of it after the declared scheme."""
    found = []
    for channel, unit in TRAJECTORY_UNITS.items():
        finding, bound = findings[channel], float(np.max(measured.round_off[channel]))
        error = float(np.max(measured.error[channel]))
        note = finding.note + _where_worse(measured, channel) * (finding.verdict == "fail")
        found.append(Row(GATE, channel, "error_max", error, unit, bound, finding.verdict, note))
        end = float(measured.error[channel][-1])
        found.append(Row(GATE, channel, "error_end", end, unit))
        if channel in measured.against_scheme:
            left = float(np.max(measured.against_scheme[channel]))
            bound = float(np.max(measured.beside_scheme[channel]))
            found.append(Row(GATE, channel, "unexplained_max", left, unit, bound))
    return found


def _where_worse(measured: MeasuredRun, channel: str) -> str:
    """Of an error that is largest late, where its bound is: at which sample it is far off."""
    error, bounds = measured.error[channel], measured.round_off[channel]
    if not np.max(error) <= np.max(bounds):
        return ""
    with np.errstate(all="ignore"):
        shares = np.where((error > 0.0) & (bounds > 0.0), error / bounds, 0.0)
    worst = int(np.argmax(shares))
    at = f"at t = {written(measured.sweep.times[worst], 4)} s"
    return f"; {at} it is {written(shares[worst], 2)} times its bound there" * bool(
        shares[worst] > 1
    )


def reported_rows(truth: Truth, measured: MeasuredRun, state: State, precision: str) -> list[Row]:
    """The start, the quaternion's length and, where it is found, single precision."""
    found = [_start(measured), _length(measured.sweep, state, truth.yardstick.eps)]
    single = _in_single(state, truth.at(measured.sweep)) if precision == "float64" else []
    if single:
        kept = f"{' and '.join(single)} {'are' if len(single) > 1 else 'is'} kept"
        note = f"{kept} in single precision, and double is declared"
        eps = float(np.finfo(np.float32).eps)
        found.append(Row(GATE, single[0], "precision", eps, "1", EPS, "fail", note))
    return found


def omega_dot_rows(system: System, state: State, omega_dot: Array, eps: float = EPS) -> list[Row]:
    """The omega-dot reported along a run, held to the equation's bound at the states it reports."""
    rows_of = equation.reported_rows(system, state, omega_dot, eps)
    found = [replace(row, gate=GATE) for row in rows_of]
    note = "the run reports another omega-dot than the equation gives at its states"
    return [replace(row, note=note) if row.verdict == "fail" else row for row in found]


def _start(measured: MeasuredRun) -> Row:
    """The first sample's distance from the state given, in parts of rounding in and out."""
    shares = {}
    for channel in TRAJECTORY_UNITS:
        allowed = measured.round_off[channel][0] + measured.floor.get(channel, np.zeros(1))[0]
        error = float(measured.error[channel][0])
        shares[channel] = error / allowed if error else 0.0
    worst = max(shares, key=lambda channel: shares[channel])
    note = "the run does not begin at the state that it is given"
    return within(GATE, worst, "start", float(shares[worst]), "1", 1.0, note)


def _length(sweep: Sweep, state: State, eps: float) -> Row:
    """How far a quaternion is from unit length; each step may round it by ``16 eps``."""
    off = np.abs(norm(state.orientation) - 1.0)
    allowed = ROUNDINGS_PER_STEP * eps * (sweep.sample_steps + 1.0)
    place = int(np.argmax(off / allowed))
    worst, bound = float(off[place]), float(allowed[place])
    note = f"the quaternion is not of unit length: it is off by {written(worst, 2)}"
    return within(GATE, "attitude", "unit_length", worst, "1", bound, note)


def _in_single(state: State, exact: State) -> list[str]:
    """Of attitude and omega those that move, and of which every value after the start is a single.

    What is a single's number in the exact motion as well shows nothing.
    """
    pairs = {
        "attitude": (state.orientation[1:], exact.orientation[1:]),
        "omega": (state.angular_velocity[1:], exact.angular_velocity[1:]),
    }
    return [
        channel
        for channel, (reported, true) in pairs.items()
        if _singles(reported) and not _singles(true) and np.ptp(reported, 0).any()
    ]


def _singles(values: Array) -> bool:
    with np.errstate(over="ignore"):
        singles = np.array_equal(values, values.astype(np.float32).astype(float))
    return singles and grain_of(values) is None


def grain_of(values: Array) -> int | None:
    """The n of a step 2^n that all values are whole multiples of, where the smaller ones would have
    finer digits in single precision; None where there is none.

    One value leaves out its last two digits by chance in one case of four.
    """
    numbers = np.abs(values[np.isfinite(values) & (values != 0.0)])
    if numbers.size == 0:
        return None
    mantissa, exponent = np.frexp(numbers)
    whole = np.ldexp(mantissa, DIGITS).astype(np.int64)
    last = (
        exponent - DIGITS + np.log2(whole & -whole).astype(int)
    )  # of the lowest digit that is set
    grain = int(np.min(last))
    if grain <= FINEST:
        return None
    return grain if np.sum(exponent - SINGLE_DIGITS <= grain - 2) >= FEWEST_COARSE else None
