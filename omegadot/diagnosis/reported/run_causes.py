"""Causes in what is reported of a run: frames, orders, samples, clocks; the stepping is sound."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.models.fitted_misreadings import ADDED, fitted_misreadings
from omegadot.diagnosis.models.misreadings import NOT_UNIT, OF_ANY_STATE, misreadings
from omegadot.diagnosis.reported.precision import decimals_reported, digits_reported
from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.reported.sample_causes import ALONE, half_step
from omegadot.diagnosis.wording.kinds import kind_of
from omegadot.gates.bounds.scales import norm
from omegadot.harness.drive import CaseResult
from omegadot.reference_impl.energy import rotational_kinetic_energy
from omegadot.reference_impl.momentum import angular_momentum
from omegadot.reference_impl.rotations import quaternion_product
from omegadot.reference_impl.system import Array, State
from omegadot.written import written

LEAST_LATE = 3  # samples
LEAST_APART = 2  # samples, each a whole state of another step


def begin_apart(reported: ReportedRun, result: CaseResult) -> bool:
    """Whether a run begins at another state than the one given: where the run before it ended.

    One step, which is not logged, is run before each: the next may begin at the end of that.
    """
    given, first, end = reported.own[:1], slice(0, 1), None
    for (_, timestep), run in result.runs.items():
        if not run.ok or not len(run.result["time"]):
            continue
        state = State(**run.result["state"])
        start = state[:1]
        apart = run.result["time"][0] == 0.0 and not reported.agrees(start, given, first)
        if end is not None and apart and np.all(np.isfinite(start.angular_velocity)):
            sweep = replace(reported.sweep, timestep=timestep)
            on = replace(reported, sweep=sweep).stepped_on(end, 1)
            if any(reported.agrees(start, one, slice(1, 2)) for one in (end, on)):
                return True
        end = state[-1:]
    return False


def not_finite(reported: ReportedRun) -> str:
    """From when on numbers are not finite; "" where all are."""
    finite = {name: np.isfinite(f).all(-1) for name, f in vars(reported.state).items()}
    bad = np.flatnonzero(~np.logical_and.reduce(list(finite.values())))
    if not len(bad):
        return ""
    names = [name.replace("_", " ") for name, ok in finite.items() if not ok.all()]
    before = reported.state[: bad[0]]
    sound = bad[0] > 0 and reported.agrees(before, reported.own[: bad[0]], slice(0, bad[0]))
    until = ", after a sound beginning" if sound else ""
    return (
        f"{' and '.join(names)}: not finite from t = {written(reported.time[bad[0]], 4)} s{until}"
    )


def last_repeated(reported: ReportedRun) -> str:
    """The last sample is the one before it in every number, and the body moves between them."""
    if len(reported.time) < 3:
        return ""
    end, before = slice(-1, None), slice(-2, -1)
    state, own = reported.state, reported.own
    same = [np.array_equal(values[-1], values[-2]) for values in vars(state).values()]
    asleep = all(np.array_equal(values[-2], values[-3]) for values in vars(state).values())
    if not all(same) or asleep or reported.agrees(own[before], own[end], end):
        return ""
    sweep = reported.sweep
    ends = [one.times[-1] for one in reported.case.sweeps if one.timestep == sweep.timestep]
    if ends and reported.time[-1] < ends[0]:
        return ""  # of a run that is looked at until it is off
    numbers = sweep.sample_steps
    short = numbers[-1] - numbers[-2] != reported.sweep.every
    where = ", after an interval shorter than the others," if short else ""
    return f"the last sample{where} is the one before, reported twice"


def misread(reported: ReportedRun) -> list[str]:
    """Conventions in which all samples are the declared run's: every one that fits."""
    if reported.agrees(reported.state, reported.own):
        return []
    later, own = slice(1, None), reported.own[1:]  # the start may be passed on as it was given
    came, found = reported.state[1:], list[str]()
    if len(own.position) > 1 and not reported.agrees(came, own, later):
        begins = reported.agrees(reported.state[:1], reported.own[:1], slice(0, 1))
        known = (one for one in misreadings(reported.case.system) if one is not NOT_UNIT)
        for one in (*known, *fitted_misreadings(came, own)):
            if ADDED in one.statement and not begins:
                continue  # it is a run from another state as well
            if reported.agrees(one.right(came), own, later):
                found.append(f"in the run, {one.statement}")
        first = reported.case.initial.orientation
        turned = quaternion_product(
            np.broadcast_to(first, came.orientation.shape), came.orientation
        )
        if reported.agrees(replace(came, orientation=turned), own, later):
            text = "the attitude of a run is relative to its start, or starts from the identity"
            found.append(text)
        moved = replace(came, position=reported.case.initial.position + came.position)
        if reported.agrees(moved, own, later):
            found = ["the position of a run is reported from where it began"]
        unsigned = own.orientation.copy()
        unsigned[:, 0] = np.abs(unsigned[:, 0])
        signed = bool(np.any(came.orientation[:, 0] < 0.0))
        if not signed and reported.agrees(came, replace(own, orientation=unsigned), later):
            found.append("the quaternion's scalar part is reported without its sign")
    for one in OF_ANY_STATE if not found else ():
        start = one.right(reported.case.initial)
        runs = (reported.beginning, reported)
        if all(run.agrees(one.right(run.state), run.stepped(initial=start)) for run in runs):
            found.append(f"on the way in and on the way out, {one.statement}")
    kinds = {kind_of(text): text for text in reversed(found)}
    plain = [text for text in found if "axes of" not in text and text in kinds.values()]
    return plain or found[:1]


def late(reported: ReportedRun) -> list[str]:
    """Samples or one quantity of another time; both readings where every step is a sample."""
    n = len(reported.time)
    if n < 3:
        return []
    after, before = slice(1, None), slice(None, -1)
    steps, every = reported.sweep.sample_steps, reported.stepped(every_step=True)
    late = every[np.maximum(steps - 1, 0)]
    early = every[np.minimum(steps + 1, steps[-1])]
    sample_late = reported.agrees(reported.state[after], reported.own[before], after)
    whole = {
        "every sample is the one before: the run is logged one sample late": sample_late,
        "every sample is the one after: the run is logged one sample early": (
            reported.agrees(reported.state[before], reported.own[after], after)
        ),
        "every sample is the state one step before: the run is logged one step late": (
            reported.agrees(reported.state, late)
        ),
        "every sample is the state one step after: the run is logged one step early": (
            reported.agrees(reported.state[before], early[before], before)
        ),
    }
    found = [text for text, holds in whole.items() if holds]
    found = found or _late_from(reported, late) or _some_apart(reported, every)
    if found:
        return found
    inner = slice(1, -1)  # the first is the state given
    if n > 3 and reported.agrees(reported.state[inner], early[inner], inner):
        return ["every sample after the first is the state one step after: logged one step early"]
    found = _alone_late(reported, every)
    if found:
        return found
    last = slice(-1, None)
    ended = reported.agrees(reported.state[last], late[last], last)
    if ended and reported.agrees(reported.state[before], reported.own[before], before):
        return ["the last step is missing: the end is the state one step before"]
    if reported.agrees(reported.state[before], reported.own[before], before):
        return [text for text in (_last_in_full(reported),) if text]
    return []


def _late_from(reported: ReportedRun, late: State) -> list[str]:
    """From some sample on each is the state of the step before, as where a buffer has wrapped."""
    yardstick, bounds = reported.truth.yardstick, reported.bounds
    own = [yardstick.distance(c, reported.state, reported.own) <= bounds[c] for c in bounds]
    first = int(np.argmin(np.logical_and.reduce(own)))  # the first that is off
    after = slice(first, None)
    if first < 2 or len(reported.time) - first < LEAST_LATE:
        return []
    if not reported.agrees(reported.state[after], late[after], after):
        return []
    since = written(reported.time[first], 4)
    return [f"from t = {since} s on, every sample is the state one step before"]


def _some_apart(reported: ReportedRun, every: State) -> list[str]:
    """Some samples are the state of the step before, or after, and all others are right.

    every: all steps of the right run.
    """
    yardstick, bounds, numbers = (
        reported.truth.yardstick,
        reported.bounds,
        reported.sweep.sample_steps,
    )

    def same(other: State) -> NDArray[np.bool_]:
        shares = [yardstick.distance(c, reported.state, other) <= bounds[c] for c in bounds]
        return np.asarray(np.logical_and.reduce(shares))

    own = same(reported.own)
    past = reported.stepped_on(every[-1:], 1)
    after = State(
        *(np.concatenate(pair) for pair in zip(*map(_values, (every, past)), strict=True))
    )
    for when, shifted in (
        ("before", every[np.maximum(numbers - 1, 0)]),
        ("after", after[numbers + 1]),
    ):
        apart = same(shifted) & ~own
        if np.all(own | apart) and LEAST_APART <= np.count_nonzero(apart) < len(own) - 1:
            first = written(reported.time[int(np.argmax(apart))], 4)
            return [f"some samples, the first at t = {first} s, are the state one step {when}"]
    return []


def _values(states: State) -> tuple[Array, ...]:
    return tuple(vars(states).values())


def _alone_late(reported: ReportedRun, every: State) -> list[str]:
    """One quantity of the sample or of the step before. every: all steps of the right run."""
    steps = reported.sweep.sample_steps
    behind = {
        "step": np.maximum(steps - 1, 0),
        "sample": np.maximum(steps - reported.sweep.every, 0),
    }
    for what, names in ALONE.items():
        found = list[str]()
        for when, shifted in behind.items():
            other = {name: getattr(every, name)[shifted] for name in names}
            if reported.agrees(reported.state, replace(reported.own, **other)):
                found.append(f"{what.rstrip(',')} alone is reported one {when} late")
        if found:
            return found
    return []


def _last_in_full(reported: ReportedRun) -> str:
    """A last interval that is shorter than the others is stepped as long as these."""
    numbers, last = reported.sweep.sample_steps, slice(-1, None)
    end = reported.stepped_on(reported.state[-2:-1])
    if numbers[-1] - numbers[-2] == reported.sweep.every:
        return ""
    text = "the last interval, shorter than the others, is stepped in full: the end is too late"
    return text if reported.agrees(reported.state[last], end, last, slack=2.0) else ""


def another_start(reported: ReportedRun) -> str:
    """The run begins at a state that is not the one given; "" where it does not."""
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


# What is seen of the numbers, whatever made them.
SEEN = (not_finite, last_repeated, digits_reported, decimals_reported)
CAUSES_REPORTED = (half_step, _rescaled)
