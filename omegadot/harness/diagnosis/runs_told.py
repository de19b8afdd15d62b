"""Causes in what is told of a run: frames, orders, samples, clocks; the stepping is sound."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.adapters.wire import state_from
from omegadot.harness.diagnosis.misreadings import OF_ANY_STATE, misreadings
from omegadot.harness.diagnosis.samples_told import digits_told, half_step, not_unit
from omegadot.harness.diagnosis.told_run import ToldRun, rows, told_run
from omegadot.harness.drive import CaseResult
from omegadot.harness.judge_case import JudgedRun
from omegadot.harness.plan import Case
from omegadot.harness.scales import norm
from omegadot.harness.truth import Truth
from omegadot.reference_impl.energy import rotational_kinetic_energy
from omegadot.reference_impl.momentum import angular_momentum
from omegadot.reference_impl.system import Array, State


def causes(case: Case, truth: Truth, result: CaseResult, run: JudgedRun) -> list[str]:
    """One sentence, or none."""
    told = told_run(case, truth, result, run)
    if told is None:
        return []
    if _begin_apart(told, result):
        return ["runs begin at other states than the one given: one is left over from a run before"]
    tried = (
        _samples,
        _clock,
        _not_finite,
        digits_told,
        _misread,
        not_unit,
        _late,
        half_step,
        _start,
    )
    for cause in (*tried, _rescaled):
        said = cause(told)
        if said:
            return [said]
    return []


def _begin_apart(told: ToldRun, result: CaseResult) -> bool:
    """Whether runs of the same case do not even begin at the same state."""
    starts, first = [], slice(0, 1)
    for run in result.runs.values():
        if run.ok and len(run.result["time"]) and run.result["time"][0] == 0.0:
            start = rows(state_from(run.result["state"]), first)
            starts += [start] if np.all(np.isfinite(start.angular_velocity)) else []
    return any(not told.agrees(start, starts[0], first) for start in starts[1:])


def _samples(told: ToldRun) -> str:
    expected, came = told.sweep.times, len(told.time)
    if came == len(expected):
        return ""
    missing = len(expected) - came
    if missing > 0 and np.allclose(told.time, expected[missing:], rtol=1e-12, atol=0.0):
        return _counted(missing, "first")
    if missing > 0 and np.allclose(told.time, expected[:-missing], rtol=1e-12, atol=0.0):
        return _counted(missing, "last")
    return f"{came} samples came back, {len(expected)} were asked for"


def _counted(missing: int, which: str) -> str:
    counted = "sample is" if missing == 1 else f"{missing} samples are"
    return f"the {which} {counted} missing"


def _clock(told: ToldRun) -> str:
    late = told.time - told.sweep.times
    tolerance = 4 * np.finfo(float).eps * told.sweep.times[-1]
    if np.all(np.abs(late) <= tolerance):
        return ""
    if np.all(np.abs(late - late[0]) <= tolerance):
        steps = late[0] / told.sweep.timestep
        return f"every time is told {late[0]:.4g} s late, {steps:.3g} steps"
    ratio = told.time[-1] / told.sweep.times[-1]
    if np.all(np.abs(told.time - ratio * told.sweep.times) <= tolerance):
        wrong = "fast" if ratio < 1.0 else "slow"
        return (
            f"the clock is told {abs(ratio - 1.0):.3g} too {wrong}: every time is off in proportion"
        )
    return ""


def _not_finite(told: ToldRun) -> str:
    finite = {name: np.isfinite(f).all(-1) for name, f in vars(told.state).items()}
    bad = np.flatnonzero(~np.logical_and.reduce(list(finite.values())))
    if not len(bad):
        return ""
    names = [name.replace("_", " ") for name, ok in finite.items() if not ok.all()]
    before = rows(told.state, slice(0, bad[0]))
    sound = bad[0] > 0 and told.agrees(before, rows(told.own, slice(0, bad[0])), slice(0, bad[0]))
    until = ", after a sound beginning" if sound else ""
    return f"{' and '.join(names)}: not finite from t = {told.time[bad[0]]:.4g} s{until}"


def _misread(told: ToldRun) -> str:
    if told.agrees(told.state, told.own):
        return ""
    for one in misreadings(told.case.system):
        if told.agrees(one.right(told.state), told.own):
            return f"in the run, {one.says}"
    for one in OF_ANY_STATE:
        start = one.right(told.case.initial)
        if told.agrees(one.right(told.state), told.stepped(initial=start)):
            return f"on the way in and on the way out, {one.says}"
    return ""


def _late(told: ToldRun) -> str:
    n = len(told.time)
    if n < 3:
        return ""
    after, before = slice(1, None), slice(None, -1)
    if told.agrees(rows(told.state, after), rows(told.own, before), after):
        return "every sample is the one before: the run is logged one sample late"
    if told.agrees(rows(told.state, before), rows(told.own, after), after):
        return "every sample is the one after: the run is logged one sample early"
    steps, every = told.sweep.sample_steps, told.stepped(every_step=True)
    late = rows(every, np.maximum(steps - 1, 0))
    if told.agrees(told.state, late):
        return "every sample is the state one step before: the run is logged one step late"
    early = rows(every, np.minimum(steps + 1, steps[-1]))
    if told.agrees(rows(told.state, before), rows(early, before), before):
        return "every sample is the state one step after: the run is logged one step early"
    last = slice(-1, None)
    ended = told.agrees(rows(told.state, last), rows(late, last), last)
    if ended and told.agrees(rows(told.state, before), rows(told.own, before), before):
        return "the last step is missing: the end is the state one step before"
    return ""


def _start(told: ToldRun) -> str:
    first = slice(0, 1)
    if told.agrees(rows(told.state, first), rows(told.own, first), first):
        return ""
    begun = State(*(values[0] for values in vars(told.state).values()))
    if told.agrees(told.state, told.stepped(initial=begun), slack=2.0):
        return "the run does not begin at the state it is given, and is sound from where it begins"
    return "the run does not begin at the state it is given"


def _rescaled(told: ToldRun) -> str:
    """Omega of the right direction and of a size that keeps something constant."""
    w, own = told.state.angular_velocity, told.own.angular_velocity
    with np.errstate(all="ignore"):
        sized = w * (norm(own) / norm(w))[:, None]
    if not told.agrees(replace(told.state, angular_velocity=sized), told.own):
        return ""
    system = told.case.system
    sizes: dict[str, Array] = {
        "kinetic energy of rotation": rotational_kinetic_energy(system, told.state),
        "angular momentum": norm(angular_momentum(system, told.state)),
    }
    bounds = told.bounds
    for (what, size), channel in zip(sizes.items(), ("energy", "angular_momentum"), strict=True):
        if np.all(np.abs(size / size[0] - 1.0) <= bounds[channel]):
            return f"omega is rescaled so that the {what} stays the same"
    return ""
