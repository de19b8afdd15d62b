"""Causes that hold the state within limits: sleep, the greatest omega, speed or turn of a step."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.stepping.fitted import search
from omegadot.diagnosis.stepping.step_ends import (
    End,
    clipped_at,
    held_below,
    speed_below,
    turn_within,
    with_end,
)
from omegadot.diagnosis.stepping.vanishing.rests import SLEEPS
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.rotations import rotation_between
from omegadot.reference_impl.system import Array, State
from omegadot.written import written

SLOW = 0.1  # rad/s, below which engines put a body to sleep


def asleep(reported: ReportedRun) -> str:
    """Omega is zero from some sample on."""
    still = ~np.any(reported.state.angular_velocity, axis=-1)
    if not still.any() or not np.all(np.any(reported.own.angular_velocity, axis=-1)):
        return ""
    first = int(np.argmax(still))
    if not np.all(still[first:]):
        return ""
    rate = float(norm(reported.own.angular_velocity[first]))
    when = f"from t = {written(reported.time[first], 4)} s on"
    text = f"omega is zero {when}, where it should be {written(rate, 2)} rad/s"
    before = slice(0, first)
    sound = first > 1 and reported.agrees(reported.state[before], reported.own[before], before)
    # a damping that is taken wrongly may stop the body as well, in its first step
    damped = bool(np.any(reported.case.system.load.damping))
    sleeps = sound or not damped or rate < SLOW
    return f"{SLEEPS}: {text}" if sleeps else text


def still(reported: ReportedRun) -> str:
    """Nothing moves, and something should."""
    pairs = zip(vars(reported.state).values(), vars(reported.own).values(), strict=True)
    rests = [
        (not np.ptp(came, axis=0).any(), bool(np.ptp(due, axis=0).any())) for came, due in pairs
    ]
    alone = any(due for _, due in rests) and all(rest for rest, _ in rests)
    return "the body does not move in the run" if alone else ""


def _limit(
    reported: ReportedRun,
    size: Callable[[Array], Array],
    end: Callable[[float], End],
    field: str = "angular_velocity",
) -> float | None:
    """The size that omega, or the velocity, is kept within by the end of each step, if any.

    The greatest that is reported is nearly the one that the steps keep to.
    """
    greatest = float(np.max(size(getattr(reported.state, field)[1:])))
    if not 0.0 < greatest < float(np.max(size(getattr(reported.own, field)[1:]))):
        return None

    def stepped(run: ReportedRun, more: float) -> State:
        return run.stepped(with_end(run.declared, end(greatest * (1.0 + more))))

    more = search(reported, stepped, 1e-6)
    return None if more is None else greatest * (1.0 + more)


def held(reported: ReportedRun) -> str:
    """Omega is scaled down to a limit."""
    found = _limit(reported, norm, held_below)
    return "" if found is None else f"omega is held below {written(found)} rad/s"


def clipped(reported: ReportedRun) -> str:
    """Every component of omega is cut at a limit."""
    found = _limit(reported, np.abs, clipped_at)
    return "" if found is None else f"each component of omega is held within {written(found)} rad/s"


def speed(reported: ReportedRun) -> str:
    """The linear velocity is scaled down to a limit."""
    found = _limit(reported, norm, speed_below, "linear_velocity")
    return "" if found is None else f"the linear velocity is held below {written(found)} m/s"


def turn_held(reported: ReportedRun) -> str:
    """The turn of each step is cut at an angle, which the greatest between samples is made of."""
    q, every = reported.state.orientation, reported.sweep.every
    greatest = float(np.max(norm(rotation_between(q[:-1], q[1:])))) / every
    if not 0.0 < greatest < np.pi / every:
        return ""

    def stepped(run: ReportedRun, more: float) -> State:
        return run.stepped(with_end(run.declared, turn_within(greatest * (1.0 + more))))

    more = search(reported, stepped, 1e-6)
    return (
        ""
        if more is None
        else f"the turn of a step is held within {written(greatest * (1 + more))} rad"
    )
