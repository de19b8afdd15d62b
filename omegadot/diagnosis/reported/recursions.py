"""Quantities that are logged as the sum of their rates over the steps, where a state gives them.

The place of a pivoted body is ``R r``, and its velocity ``R (omega x r)``. Summed up they part from
these: ``x_(n+1) = x_n + h v``, with v of the step's start, of its end, or the mean of both.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product

import numpy as np

from omegadot.diagnosis.reported.of_steps import NEAR, SLACK, Way
from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.wording.digits import number
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.system import Array, State

PLACE, VELOCITY = "position", "linear_velocity"
SUMS = {
    "that of the step's end": (0.0, 1.0),
    "that of the step's start": (1.0, 0.0),
    "the mean of those at its two ends": (0.5, 0.5),
}
LEAVES = "it leaves the pivot"
PARTS = "it is no longer omega x r"


def sums_of_steps(reported: ReportedRun, every: State, name: str) -> Iterator[Way]:
    """Each sum, with what it makes of one quantity. every: all steps of the right run."""
    if name not in (PLACE, VELOCITY) or reported.case.system.load.pivot is None:
        return
    for which in SUMS:
        if name == PLACE:
            made = _sum(reported, name, every.linear_velocity, which)
            text = f"the position of a pivoted body is summed up from the velocity, {_by(which)}"
            yield f"{text}: {LEAVES}", made[reported.sweep.sample_steps], SLACK
        else:
            made = _sum(reported, name, _accelerations(reported, every), which)
            text = f"the velocity of a pivoted body is summed up from its rate, {_by(which)}"
            yield f"{text}: {PARTS}", made[reported.sweep.sample_steps], SLACK


def added_in_steps(reported: ReportedRun, every: State) -> Iterator[Way]:
    """Of a free body, whose place acts on nothing: what each step moves it by in addition.

    every: all steps of the right run.
    """
    if reported.case.system.load.pivot is not None:
        return
    h, numbers = reported.sweep.timestep, reported.sweep.sample_steps
    off = np.ravel(reported.state.position - every.position[numbers])
    for text, power in (("the velocity", 1), ("the linear acceleration", 2)):
        rate = every.linear_velocity if power == 1 else _accelerations(reported, every)
        for which, part in (("start", rate[:-1]), ("end", rate[1:])):
            sums = np.cumsum(np.concatenate((0.0 * rate[:1], h**power * part)), axis=0)[numbers]
            line = np.ravel(sums)
            size = float(line @ line)
            times = float(line @ off) / size if size > 0.0 and np.isfinite(size) else 0.0
            if abs(times) > NEAR:
                by = f"{number(float(f'{times:.6g}'))} h{'^2' * (power > 1)} times {text}"
                at = "" if np.array_equal(rate[:-1], rate[1:]) else f" at its {which}"
                yield (
                    f"each step moves the position by {by}{at} in addition",
                    every.position[numbers] + times * sums,
                    SLACK,
                )


def both_summed(reported: ReportedRun) -> list[str]:
    """Of a pivoted body the velocity from its rate, and the position from that velocity."""
    if reported.case.system.load.pivot is None:
        return []
    own, came, later = reported.own, reported.state, slice(1, None)
    right = replace(came, position=own.position, linear_velocity=own.linear_velocity)
    if not reported.agrees(right[later], own[later], later):
        return []
    every, numbers = reported.stepped(every_step=True), reported.sweep.sample_steps
    rate, found = _accelerations(reported, every), list[str]()
    for one, other in product(SUMS, repeat=2):
        velocity = _sum(reported, VELOCITY, rate, one)
        place = _sum(reported, PLACE, velocity, other)
        made = replace(own, linear_velocity=velocity[numbers], position=place[numbers])
        if reported.agrees(came[later], made[later], later, SLACK):
            text = f"the velocity of a pivoted body is summed up from its rate, {_by(one)}"
            more = f"and the position from that velocity, {_by(other)}"
            found.append(f"{text}, {more}: {LEAVES}")
    return found


def _by(which: str) -> str:
    return f"h times {which} in each step"


def _accelerations(reported: ReportedRun, every: State) -> Array:
    return forward_dynamics(reported.case.system, every).linear


def _sum(reported: ReportedRun, name: str, rate: Array, which: str) -> Array:
    """(n + 1, 3): from the first sample on, one step after the other, as an engine rounds."""
    start, end = SUMS[which]
    steps = reported.sweep.timestep * (start * rate[:-1] + end * rate[1:])
    first = getattr(reported.state, name)[:1]
    return np.cumsum(np.concatenate((first, steps)), axis=0)
