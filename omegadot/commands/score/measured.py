"""How far a trace is from the exact trajectory, in every channel that it states something about."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.commands.score.bounds import Rounding
from omegadot.commands.score.exact_trajectory import ExactTrajectory
from omegadot.commands.score.trace import Trace
from omegadot.gates.interpolation import Hermite
from omegadot.gates.measured_run import CHANNELS
from omegadot.gates.phase import flip_rows
from omegadot.gates.rows import Row
from omegadot.gates.scales import norm
from omegadot.gates.truth import Truth
from omegadot.reference_impl.momentum import angular_momentum
from omegadot.reference_impl.system import Array, State


@dataclass(frozen=True)
class Measured:
    """A trace measured. state: with the exact trajectory's values where the trace gives none.

    error: (n,) by channel, of those given.  absent: why the others are not.  remarks: how a channel
    that only a part of the trace bears on was measured.
    """

    state: State
    error: dict[str, Array]
    absent: dict[str, str]
    remarks: dict[str, str]


def filled(trace: Trace, exact: State) -> State:
    """The trace's state, and the exact one where it gives nothing."""

    def own(found: Array | None, instead: Array) -> Array:
        return instead if found is None else found

    return State(
        own(trace.orientation, exact.orientation),
        own(trace.angular_velocity, exact.angular_velocity),
        own(trace.position, exact.position),
        own(trace.linear_velocity, exact.linear_velocity),
    )


def absent_channels(trace: Trace, truth: Truth) -> dict[str, str]:
    """The channels that a trace cannot be judged on, each with what it lacks."""
    load = truth.yardstick.system.load
    spins, turns = trace.angular_velocity is not None, trace.orientation is not None
    needed = {
        "omega": {"omega": spins},
        "attitude": {"the attitude": turns},
        "position": {"the position": trace.position is not None},
        "energy": {"omega": spins},
        "angular_momentum": {"omega": spins},
        "linear_momentum": {"the velocity": trace.linear_velocity is not None},
    }
    if load.pivot is not None:  # the attitude places the body
        needed["energy"]["the attitude"] = turns
        needed["angular_momentum"]["the attitude"] = turns
    found = {}
    for channel, parts in needed.items():
        lacking = [name for name, there in parts.items() if not there]
        if lacking:
            found[channel] = f"not given: the trace lacks {' and '.join(lacking)}"
    return found


def measure_trace(trace: Trace, truth: Truth) -> Measured:
    """The distances from the exact trajectory."""
    absent, exact = absent_channels(trace, truth), truth.state
    state = filled(trace, exact)
    error = {c: distance(truth, trace, c, state, exact) for c in CHANNELS if c not in absent}
    remarks = {}
    if "angular_momentum" in error and trace.orientation is None:
        remarks["angular_momentum"] = "its length alone, the attitude is not given"
    if "energy" in error and trace.linear_velocity is None:
        load = truth.yardstick.system.load
        if load.pivot is None and (np.any(exact.linear_velocity) or np.any(load.gravity)):
            remarks["energy"] = "of the rotation alone, the velocity is not given"
    return Measured(state, error, absent, remarks)


def distance(truth: Truth, trace: Trace, channel: str, one: State, other: State) -> Array:
    """(n,): as the yardstick has it, but momentum by its length where no attitude is given."""
    yardstick = truth.yardstick
    if channel == "angular_momentum" and trace.orientation is None:
        sizes = [norm(angular_momentum(yardstick.system, state)) for state in (one, other)]
        return np.asarray(np.abs(sizes[0] - sizes[1]) / yardstick.sizes[channel])
    return yardstick.distance(channel, one, other)


def flips_of(
    truth: Truth, trajectory: ExactTrajectory, trace: Trace, measured: Measured, bound: Rounding
) -> list[Row]:
    """The largest error of a flip's time; none without omega, or where nothing flips.

    Both trajectories are interpolated alike between the trace's samples. What that leaves open is
    the cubic's own error, found half-way between the samples on the exact trajectory.
    """
    if trace.angular_velocity is None or len(trace.times) < 3:
        return []
    exact = Hermite(truth.times, truth.state.angular_velocity, truth.omega_dot)
    middle = 0.5 * (trace.times[1:] + trace.times[:-1])
    gap = float(np.max(norm(exact.at(middle)[0] - trajectory(middle).angular_velocity)))
    rounding = truth.yardstick.rate * float(np.max(bound["omega"]))
    with np.errstate(all="ignore"):
        return flip_rows(truth.yardstick.system, exact, measured.state, rounding + gap, rounding)
