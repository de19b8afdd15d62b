"""How an engine rounds omega-dot, as it shows between states that are a few roundings apart.

An engine that keeps the angular momentum takes omega from it by the inverse of the inertia. The
products of that sum are ``cond`` times omega, so that omega is off by ``cond`` roundings in any
direction, and ``omega x J omega`` over the least moment by ``cond^2``. Such rounding is another at
the next number; what a wrong equation leaves is the same there.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.gates.bounds.scales import body_scale, torque_size
from omegadot.gates.rows import Row, within
from omegadot.reference_impl.arithmetic.precision import extended, in_doubles, to_double
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.system import Array, State, System

NUDGES = np.array([3.0, -5.0, 7.0])  # roundings, of the components of omega
OF_SHOWN = 4.0  # the largest of some roundings, over the largest that others are apart
PART, MOST = 1 / 16, 0.5  # of an error that is rounding: what changes, and at how many states
CHANNEL = "omega_dot"


def nudged(states: State, eps: float) -> State:
    """The states with an omega that is a few roundings off."""
    return replace(states, angular_velocity=states.angular_velocity * (1.0 + eps * NUDGES))


def rounding_shown(system: System, pairs: list[tuple[State, Array]], strict: float) -> float:
    """The largest change of an omega-dot's error from one of two states to the other, relative.

    pairs: two of the states (n,), with the engine's omega-dot there, (n, 3).  The size is that of
    the equation gate, ``S / J``.  Nothing where most errors beyond the bound are the same at both:
    a number of few digits may change at some states as well.
    """
    errors = list[Array]()
    for states, found in pairs:
        true = forward_dynamics(extended(system), extended(states))
        size = torque_size(system, states, in_doubles(true)) / body_scale(system).largest
        with np.errstate(divide="ignore", invalid="ignore"):
            errors.append(np.asarray(to_double(found - true.angular)) / size[..., None])
    change, error = (np.hypot.reduce(x, -1) for x in (errors[1] - errors[0], errors[0]))
    known = np.isfinite(change)
    beyond = known & (error > strict)
    changed = change >= PART * error
    if np.count_nonzero(beyond & changed) < MOST * np.count_nonzero(beyond):
        return 0.0
    return float(np.max(change, where=known, initial=0.0))


def bound_of(system: System, shown: float, strict: float) -> float:
    """The bound of omega-dot by what rounding is shown; `cond` times the gate's own at most."""
    scale = body_scale(system)
    return max(strict, min(OF_SHOWN * shown, strict * scale.largest / scale.smallest))


def may_be_rounding(system: System, rows: list[Row]) -> bool:
    """Whether omega-dot is off by so little that an engine's own rounding may be all of it."""
    scale = body_scale(system)
    off = [row for row in rows if row.channel == CHANNEL and row.verdict == "fail"]
    most = scale.largest / scale.smallest
    return bool(off) and all(row.bound and row.value <= most * row.bound for row in off)


def of_own_rounding(row: Row, bound: float) -> Row:
    """A row at that bound, where it is one of omega-dot and beyond its own."""
    if row.channel != CHANNEL or row.verdict != "fail" or not row.bound:
        return row
    return within(
        row.gate, CHANNEL, row.metric, row.value, row.unit, max(row.bound, bound), row.note
    )
