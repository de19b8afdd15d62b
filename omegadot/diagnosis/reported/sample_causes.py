"""Causes in the samples of a run: of half a step before, or wrong in places.

The last resort, where no single cause explains a whole run, is where it is sound: sample to sample,
and quantity by quantity. Every sample is stepped on by the declared scheme to the next, so that
what is wrong at one place does not spoil the rest.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.wording.conditions import only_where
from omegadot.gates.bounds.scales import angular_size, norm
from omegadot.gates.case import Case
from omegadot.gates.errors.measured_run import CHANNELS
from omegadot.gates.states.equation import BOUND
from omegadot.gates.truth import Truth
from omegadot.harness.drive import CaseResult
from omegadot.harness.judging.judged_run import JudgedRun
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import rotate, turn_in_body
from omegadot.reference_impl.system import Array, State
from omegadot.written import written

EPS_SINGLE = float(np.finfo(np.float32).eps)
LEAST_CHANGES = 3
LEAST_OF_GUESS = 4  # intervals, of a run whose scheme is not declared
LEAST_BESIDE = 6  # intervals, four of them sound, that show a sample to be alone
ORDERS, SHOWS = 3.0, 10.0  # an error may go with so high a power of the motion in an interval
# One interval's rounding is within the bound of its end; its start is rounded, too.
SLACK = 2.0
ALONE = {
    "the attitude": ("orientation",),
    "omega": ("angular_velocity",),
    "the position": ("position",),
    "the linear velocity": ("linear_velocity",),
    "the linear velocity, with the position,": ("linear_velocity", "position"),
}


def not_unit(reported: ReportedRun) -> str:
    """The turning is sound but for the quaternion's length, which may move the places, too."""
    length = norm(reported.state.orientation)[:, None]
    off = float(np.max(np.abs(length - 1.0)))
    places = {"position": reported.own.position, "linear_velocity": reported.own.linear_velocity}
    longer = replace(reported.state, **places)
    unit = replace(longer, orientation=reported.state.orientation / length)
    if reported.agrees(longer, reported.own) or not reported.agrees(unit, reported.own):
        return ""
    return f"the quaternion is not of unit length in the run: it is off by up to {written(off, 2)}"


def half_step(reported: ReportedRun) -> str:
    """Attitude, omega or velocity, but for the start, are those of half a step before or after.

    Of a run that is sound as it is none is, though what stays the same is that of any time.
    """
    if reported.agrees(reported.state, reported.own):
        return ""
    h = reported.sweep.timestep
    q, w = reported.own.orientation, reported.own.angular_velocity
    rates, v = forward_dynamics(reported.case.system, reported.own), reported.own.linear_velocity
    for sign, when in ((-0.5, "before"), (0.5, "after")):
        turned = np.concatenate((q[:1], turn_in_body(q, w, sign * h)[1:]))
        if reported.agrees(reported.state, replace(reported.own, orientation=turned)):
            return f"the attitude reported is that of half a step {when}"
        moved = np.concatenate((w[:1], (w + sign * h * rates.angular)[1:]))
        if reported.agrees(reported.state, replace(reported.own, angular_velocity=moved)):
            return f"omega is reported as of half a step {when}"
        moved = np.concatenate((v[:1], (v + sign * h * rates.linear)[1:]))
        if reported.agrees(reported.state, replace(reported.own, linear_velocity=moved)):
            return f"the linear velocity is reported as of half a step {when}"
    return ""


def omega_dot_late(case: Case, truth: Truth, result: CaseResult, run: JudgedRun) -> str:
    """What the omega-dot reported along a run is: of another sample, in world axes, of one term.

    Of another sample the ends have none.
    """
    answer = result.runs.get((run.integrator.name, run.sweep.timestep))
    if answer is None or not answer.ok:
        return ""
    omega_dot, state = answer.result["omega_dot"], State(**answer.result["state"])
    system, inner = case.system, slice(1, -1)
    true = forward_dynamics(system, state)
    bound = BOUND * angular_size(system, state, true)
    for shift, when in ((1, "before"), (-1, "after")):
        apart = norm(np.roll(true.angular, shift, axis=0) - omega_dot)
        if np.all(apart[inner] <= np.maximum(bound, np.roll(bound, shift))[inner]):
            return f"the omega-dot reported along the run is that of the sample {when}"
    others = {
        "looks like world axes: it matches after R^T": rotate(state.orientation, true.angular),
        "has the wrong sign": -true.angular,
        "is zero": 0 * true.angular,
        "is kept in single precision": true.angular.astype(np.float32).astype(float),
    }
    for text, other in others.items():
        if np.all(
            norm(other - omega_dot)
            <= bound + 2.0 * EPS_SINGLE * norm(true.angular) * ("single" in text)
        ):
            return f"the omega-dot reported along the run {text}"
    return ""


def _shares_of_bounds(reported: ReportedRun) -> Array:
    """(n - 1,): how far the declared scheme misses each next sample, in parts of the bounds."""
    numbers = reported.sweep.sample_steps
    count = int(np.count_nonzero(np.diff(numbers) == reported.sweep.every))
    ends = reported.stepped_on(reported.state[:count])
    then, bounds = reported.state[1 : count + 1], reported.bounds
    shares = [
        reported.truth.yardstick.distance(channel, then, ends) / bounds[channel][1 : count + 1]
        for channel in CHANNELS
    ]
    return np.asarray(np.nan_to_num(np.max(shares, axis=0), nan=np.inf))


def _would_show(reported: ReportedRun, shares: Array) -> bool:
    """Whether the mistake of the first steps, made in the later ones, would show there as well.

    Bounds grow along a run, and where the body comes to rest every scheme is the same.
    """
    count, sound = len(shares), shares <= SLACK
    bound = reported.bounds["omega"][1 : count + 1]
    w = reported.state.angular_velocity[: count + 1]
    moves = norm(np.diff(w, axis=0)) + norm(w[:-1])
    off = float(np.median((shares * bound / moves**ORDERS)[~sound]))
    return bool(np.all(off * moves[sound] ** ORDERS > SHOWS * SLACK * bound[sound]))


def one_field(reported: ReportedRun) -> str:
    """All but one quantity are sound, and so they are stepped with the right one."""
    for text, names in ALONE.items():
        if not reported.is_declared and text == "the attitude":
            continue  # schemes that are no guess here have the same omega and another attitude
        right = {name: getattr(reported.own, name) for name in names}
        if reported.agrees(replace(reported.state, **right), reported.own):
            return f"{text} alone is wrong in the run{_off_by(reported, names[0])}"
    return ""


def last_sample(reported: ReportedRun) -> str:
    """All samples are sound but for one quantity of the last; of more of its quantities "".

    What is wrong in the last step would move the others with it, or be one step's error.
    """
    count = len(reported.time)
    before, end = slice(0, count - 1), slice(count - 1, count)
    state, own = reported.state, reported.own
    if count < LEAST_BESIDE or not reported.agrees(state[before], own[before], before):
        return ""
    if reported.agrees(state[end], own[end], end):
        return ""
    sweeps, knob = reported.case.sweeps_of(reported.integrator), reported.sweep.knob
    if any(one.knob == knob and reported.time[-1] < one.times[-1] for one in sweeps):
        return ""  # a run that is looked at until it is off
    for text, names in ALONE.items():
        right = {name: getattr(own, name)[end] for name in names}
        if reported.agrees(replace(state[end], **right), own[end], end):
            return f"{text} of the last sample alone is wrong{_off_by(reported, names[0], end)}"
    return ""


def _off_by(reported: ReportedRun, name: str, samples: slice = slice(None)) -> str:
    came, own = (getattr(one, name)[samples] for one in (reported.state, reported.own))
    off, size = float(np.max(np.abs(came - own))), float(np.max(np.abs(own)))
    return f", by up to {written(off / size, 2)} of it" if size else ", where it is to be nothing"


def first_wrong(reported: ReportedRun) -> int | None:
    """The last sample up to which a run is sound, where it is wrong ever after.

    The number of intervals of a run that is sound throughout; None of any other.
    """
    sound = _shares_of_bounds(reported) <= SLACK
    first = int(np.argmin(np.append(sound, False)))
    return first if first > 0 and not np.any(sound[first:]) else None


def intervals(reported: ReportedRun) -> str:
    """From which sample to which the steps are wrong."""
    shares = _shares_of_bounds(reported)
    sound = shares <= SLACK
    wrong = np.flatnonzero(~sound)
    # a scheme of several steps begins by one that is not its own
    least = 1 if reported.is_declared else LEAST_OF_GUESS
    if len(sound) < 3 or not len(wrong) or np.count_nonzero(sound) < least:
        return ""
    time, first, last = reported.time, int(wrong[0]), int(wrong[-1])
    together = len(wrong) == last - first + 1
    early = together and first == 0 and 2 * len(wrong) <= len(sound)
    if early and _would_show(reported, shares):
        start = written(time[last + 1], 4)
        return f"only the first steps are wrong: from t = {start} s on, the run is sound"
    if len(wrong) == 1 and first + 1 < len(sound):
        between = f"between t = {written(time[first], 4)} s and {written(time[first + 1], 4)} s"
        return f"the run is wrong once, {between}: before and after it is sound"
    alone = len(wrong) == 2 and together and first > 0 and last + 1 < len(sound)
    if alone and len(sound) >= LEAST_BESIDE and _goes_on(reported, first):
        pairs = (values[last] == values[last - 1] for values in vars(reported.state).values())
        twice = all(bool(np.all(pair)) for pair in pairs)
        what = "is the one before, reported twice" if twice else "alone does not belong to the run"
        return f"the sample at t = {written(time[last], 4)} s {what}"
    if len(wrong) == 1:
        return (
            f"only the steps after t = {written(time[first], 4)} s, the last of the run, are wrong"
        )
    if first > 0 and len(wrong) == len(sound) - first:
        until = written(time[first], 4)
        return f"the run is sound until t = {until} s, and between no two samples after it"
    if np.count_nonzero(np.diff(sound.astype(int))) < LEAST_CHANGES:
        return ""  # what changes once goes with the time as well as with anything that grows
    where = only_where([(reported.case.system, reported.state[: len(sound)], sound)])
    return f"samples are wrong only where {where}" if where else ""


def _goes_on(reported: ReportedRun, sample: int) -> bool:
    """Whether a sample leads to the second after it, past the one between them."""
    start = reported.state[sample : sample + 1]
    end = reported.stepped_on(reported.stepped_on(start))
    after = slice(sample + 2, sample + 3)
    return reported.agrees(reported.state[after], end, after, slack=SLACK)
