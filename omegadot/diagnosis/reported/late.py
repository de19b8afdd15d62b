"""Samples of another time: of the step or the sample before or after, all of them or some."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.reported.sample_causes import ALONE
from omegadot.reference_impl.system import Array, State
from omegadot.written import written

LEAST_LATE = 3  # samples
LEAST_APART = 2  # samples, each a whole state of another step


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
    found = found or _other_intervals(reported, every)
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


def _other_intervals(reported: ReportedRun, every: State) -> list[str]:
    """Each interval between samples is a step longer or shorter than requested: sample k is k off.

    So it is where steps are counted with > for >=.
    """
    steps = reported.sweep.sample_steps
    places = np.arange(len(steps))
    for what, numbers in (("longer", steps + places), ("shorter", steps - places)):
        if not numbers.any():
            continue  # no step at all is a body that does not move
        states = _stepped_past(reported, every, int(numbers[-1]))
        if reported.agrees(reported.state, states[numbers]):
            return [f"each interval between samples is one step {what} than requested"]
    return []


def _stepped_past(reported: ReportedRun, every: State, last: int) -> State:
    """All steps of the right run, and those after it up to this one."""
    found = [every]
    for _ in range(last - len(every.position) + 1):
        found.append(reported.stepped_on(found[-1][-1:], 1))
    return State(*(np.concatenate(one) for one in zip(*map(_values, found), strict=True)))


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
    after = _stepped_past(reported, every, len(every.position))
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
