"""Causes with one number in them: a run is stepped again until it comes to the reported one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from omegadot.diagnosis.reported.clock import GRIDS
from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.rotations import rotation_between
from omegadot.reference_impl.solutions.growth import changes
from omegadot.reference_impl.system import Array, State
from omegadot.written import written

SINGLE = "the step is kept in single precision"
MOST_TRIES = 8
CONVERGES = 0.3  # what a try must leave of the distance before it
# A fitted run has come out of a search that ends within rounding, and bounds are of one run.
SLACK = 4.0
WHOLE = 1e-9  # relative: what a fitted step is known to
FAR = 0.1  # relative: a number that a search from the right one may not reach
STILL = 1e-6  # a factor of the step that leaves nothing of it


def search(
    reported: ReportedRun,
    stepped: Callable[[ReportedRun, float], State],
    delta: float,
    start: float = 0.0,
) -> float | None:
    """The number with which a run comes to the reported one, by Gauss-Newton; None if none does.

    It is looked for in the run's beginning first. stepped: a run by this number.  delta: a small
    change of the number, of which one per cent is still distinguished from rounding.
    """
    if reported.beginning is not reported:
        found = _search(reported.beginning, stepped, delta, start)
        if found is None:
            return None
        start = found
    return _search(reported, stepped, delta, start)


def _search(
    reported: ReportedRun,
    stepped: Callable[[ReportedRun, float], State],
    delta: float,
    found: float,
) -> float | None:
    rate = reported.truth.yardstick.rate

    def apart(state: State) -> Array:
        return np.ravel(changes(state, reported.state, rate))

    before = np.inf
    for _ in range(MOST_TRIES):
        here = stepped(reported, found)
        if reported.agrees(reported.state, here, slack=SLACK):
            return found
        left = float(norm(apart(here)))
        if not left < CONVERGES * before:
            return None
        before = left
        slope = (apart(here) - apart(stepped(reported, found + delta))) / delta
        size = float(slope @ slope)
        if not size > 0.0 or not np.isfinite(size):
            return None
        found += float(slope @ apart(here)) / size
        if not np.isfinite(found):
            return None
    return None


def longer(reported: ReportedRun) -> str:
    """Every step is too long or too short by a part."""
    h = reported.sweep.timestep
    part = search(
        reported, lambda run, k: run.stepped(timestep=h * (1.0 + k)), 1e-6, _turned(reported)
    )
    if part is None or part == 0.0 or abs(1.0 + part) < STILL:
        return ""
    single = float(np.float32(h))
    if single != h and reported.is_made(partial(ReportedRun.stepped, timestep=single), SLACK):
        return SINGLE
    text = f"steps are {written(100 * abs(part), 4)} % too {'long' if part > 0 else 'short'}"
    return f"{text}{_grid(h, h * (1.0 + part))}"


def _turned(reported: ReportedRun) -> float:
    """By which part the first interval turns too far: a first guess of a step that is far off."""
    with np.errstate(all="ignore"):
        came, due = (
            norm(rotation_between(*x.orientation[:2])) for x in (reported.state, reported.own)
        )
        part = float(came / due) - 1.0
    return part if np.isfinite(part) and abs(part) > FAR and part > -1.0 else 0.0


def _grid(requested: float, taken: float) -> str:
    """The unit in whole numbers of which a step is taken, where the requested one is not."""
    for unit, what in GRIDS.items():
        near, due = round(taken / unit), requested / unit
        whole = abs(taken / unit - near) < WHOLE * near
        if whole and abs(due - near) <= 1.0 and abs(due - round(due)) > 10 * WHOLE * near:
            return f": rounded to whole {what}"
    return ""


def damped(reported: ReportedRun) -> str:
    """Another damping than the one requested."""
    system, yardstick = reported.case.system, reported.truth.yardstick

    def stepped(run: ReportedRun, damping: float) -> State:
        more = replace(system.load, damping=system.load.damping + damping)
        return run.stepped(system=replace(system, load=more))

    scale = yardstick.scale.smallest / float(reported.time[-1])  # takes a run's time to act
    found = search(reported, stepped, 1e-6 * scale)
    if found is None or found == 0.0:
        return ""
    requested = float(system.load.damping)
    if not requested:
        return (
            f"a damping of {written(found, 3)} N m s/rad acts in the steps that was not requested"
        )
    shown, due = (f"{written(x, 3)} N m s/rad" for x in (requested + found, requested))
    return f"the damping that acts in the steps is {shown}, where {due} was requested"
