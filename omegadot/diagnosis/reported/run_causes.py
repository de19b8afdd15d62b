"""Causes in what is reported of a run: frames, orders, samples, clocks; the stepping is sound."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.diagnosis.models.misreadings import OF_ANY_STATE, misreadings
from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.reported.sample_causes import digits_reported, half_step, not_unit
from omegadot.gates.bounds.scales import norm
from omegadot.harness.drive import CaseResult
from omegadot.reference_impl.energy import rotational_kinetic_energy
from omegadot.reference_impl.momentum import angular_momentum
from omegadot.reference_impl.system import Array, State


def begin_apart(reported: ReportedRun, result: CaseResult) -> bool:
    """Whether runs of the same case do not even begin at the same state."""
    starts, first = [], slice(0, 1)
    for run in result.runs.values():
        if run.ok and len(run.result["time"]) and run.result["time"][0] == 0.0:
            start = State(**run.result["state"])[first]
            starts += [start] if np.all(np.isfinite(start.angular_velocity)) else []
    return any(not reported.agrees(start, starts[0], first) for start in starts[1:])


def _samples(reported: ReportedRun) -> str:
    expected, came = reported.sweep.times, len(reported.time)
    if came == len(expected):
        return ""
    missing = len(expected) - came
    counted = "sample is" if missing == 1 else f"{missing} samples are"
    for which, left in (("first", expected[missing:]), ("last", expected[:-missing])):
        if missing > 0 and np.allclose(reported.time, left, rtol=1e-12, atol=0.0):
            return f"the {which} {counted} missing"
    return f"{came} samples came back, {len(expected)} were requested"


def _clock(reported: ReportedRun) -> str:
    late = reported.time - reported.sweep.times
    tolerance = 4 * np.finfo(float).eps * reported.sweep.times[-1]
    if np.all(np.abs(late) <= tolerance):
        return ""
    if np.all(np.abs(late - late[0]) <= tolerance):
        steps = late[0] / reported.sweep.timestep
        return f"every time is reported {late[0]:.4g} s late, {steps:.3g} steps"
    ratio = reported.time[-1] / reported.sweep.times[-1]
    if np.all(np.abs(reported.time - ratio * reported.sweep.times) <= tolerance):
        wrong = "fast" if ratio < 1.0 else "slow"
        return f"the clock runs {abs(ratio - 1.0):.3g} too {wrong}: every time is off in proportion"
    return ""


def _not_finite(reported: ReportedRun) -> str:
    finite = {name: np.isfinite(f).all(-1) for name, f in vars(reported.state).items()}
    bad = np.flatnonzero(~np.logical_and.reduce(list(finite.values())))
    if not len(bad):
        return ""
    names = [name.replace("_", " ") for name, ok in finite.items() if not ok.all()]
    before = reported.state[: bad[0]]
    sound = bad[0] > 0 and reported.agrees(before, reported.own[: bad[0]], slice(0, bad[0]))
    until = ", after a sound beginning" if sound else ""
    return f"{' and '.join(names)}: not finite from t = {reported.time[bad[0]]:.4g} s{until}"


def _misread(reported: ReportedRun) -> str:
    if reported.agrees(reported.state, reported.own):
        return ""
    for one in misreadings(reported.case.system):
        if reported.agrees(one.right(reported.state), reported.own):
            return f"in the run, {one.statement}"
    for one in OF_ANY_STATE:
        start = one.right(reported.case.initial)
        if reported.agrees(one.right(reported.state), reported.stepped(initial=start)):
            return f"on the way in and on the way out, {one.statement}"
    return ""


def _late(reported: ReportedRun) -> str:
    n = len(reported.time)
    if n < 3:
        return ""
    after, before = slice(1, None), slice(None, -1)
    if reported.agrees(reported.state[after], reported.own[before], after):
        return "every sample is the one before: the run is logged one sample late"
    if reported.agrees(reported.state[before], reported.own[after], after):
        return "every sample is the one after: the run is logged one sample early"
    steps, every = reported.sweep.sample_steps, reported.stepped(every_step=True)
    late = every[np.maximum(steps - 1, 0)]
    if reported.agrees(reported.state, late):
        return "every sample is the state one step before: the run is logged one step late"
    early = every[np.minimum(steps + 1, steps[-1])]
    if reported.agrees(reported.state[before], early[before], before):
        return "every sample is the state one step after: the run is logged one step early"
    last = slice(-1, None)
    ended = reported.agrees(reported.state[last], late[last], last)
    if ended and reported.agrees(reported.state[before], reported.own[before], before):
        return "the last step is missing: the end is the state one step before"
    return ""


def _start(reported: ReportedRun) -> str:
    first = slice(0, 1)
    if reported.agrees(reported.state[first], reported.own[first], first):
        return ""
    start = reported.state[0]
    if reported.agrees(reported.state, reported.stepped(initial=start), slack=2.0):
        return "the run does not begin at the state it is given, and is sound from where it begins"
    return "the run does not begin at the state it is given"


def _rescaled(reported: ReportedRun) -> str:
    """Omega of the right direction and of a size that keeps something constant."""
    w, own = reported.state.angular_velocity, reported.own.angular_velocity
    sized = w * (norm(own) / norm(w))[:, None]
    if not reported.agrees(replace(reported.state, angular_velocity=sized), reported.own):
        return ""
    system = reported.case.system
    sizes: dict[str, Array] = {
        "kinetic energy of rotation": rotational_kinetic_energy(system, reported.state),
        "angular momentum": norm(angular_momentum(system, reported.state)),
    }
    bounds = reported.bounds
    for (what, size), channel in zip(sizes.items(), ("energy", "angular_momentum"), strict=True):
        if np.all(np.abs(size / size[0] - 1.0) <= bounds[channel]):
            return f"omega is rescaled so that the {what} stays the same"
    return ""


CAUSES_REPORTED = (
    _samples,
    _clock,
    _not_finite,
    digits_reported,
    _misread,
    not_unit,
    _late,
    half_step,
    _start,
    _rescaled,
)
