"""How far a trace is from the exact trajectory, in every channel that it states something about."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from omegadot.commands.score.exact_trajectory import (
    ExactTrajectory,
    Rounding,
    bounds_of,
    exact_trajectory,
)
from omegadot.commands.score.trace import Trace
from omegadot.gates.bounds.measures import INVARIANT_CHANNELS
from omegadot.gates.bounds.scales import norm
from omegadot.gates.case import Case
from omegadot.gates.errors.measured_run import CHANNELS
from omegadot.gates.rows import Row
from omegadot.gates.runs.interpolation import Hermite
from omegadot.gates.runs.phase import flip_rows
from omegadot.gates.truth import Truth
from omegadot.reference_impl.momentum import angular_momentum
from omegadot.reference_impl.system import Array, State, System

PARTS = {
    "angular_velocity": "omega",
    "orientation": "the attitude",
    "position": "the position",
    "linear_velocity": "the velocity",
}
NEEDED = {
    "omega": ("omega",),
    "attitude": ("the attitude",),
    "position": ("the position",),
    "energy": ("omega",),
    "angular_momentum": ("omega",),
    "linear_momentum": ("the velocity",),
}


@dataclass(frozen=True)
class Measured:
    """A trace measured. state: with the exact trajectory's values where the trace gives none.

    error: (n,) by channel, of those given.  absent: why the others are not.  remarks: how a channel
    that only a part of the trace bears on was measured.  digits: (n,) by channel, the resolution.
    bound: digits, rounding and floor together.  values_open: digits, but those of the stamps.
    """

    case: Case
    trace: Trace
    truth: Truth
    trajectory: ExactTrajectory
    state: State
    error: dict[str, Array]
    absent: dict[str, str]
    remarks: dict[str, str]
    digits: Rounding
    bound: Rounding
    values_open: Rounding

    @property
    def rate(self) -> float:
        """rad/s, which omega's errors are relative to."""
        return self.truth.yardstick.rate


def absent_channels(trace: Trace, truth: Truth) -> dict[str, str]:
    """The channels that a trace cannot be judged on, each with what it lacks."""
    lacking = [name for field, name in PARTS.items() if getattr(trace, field) is None]
    parts = [name for field, name in PARTS.items() if partial(getattr(trace, field))]
    found = {}
    for channel, needed in NEEDED.items():
        on_pivot = truth.yardstick.system.load.pivot is not None
        placed = on_pivot and channel in ("energy", "angular_momentum")  # by the attitude
        names = {*needed, "the attitude"} if placed else needed
        missing = [name for name in lacking if name in names]
        if channel in INVARIANT_CHANNELS:
            missing += [f"a component of {name}" for name in parts if name in names]
        if missing:
            found[channel] = f"not given: the trace lacks {' and '.join(missing)}"
    return found


def _remarks(case: Case, trace: Trace, error: dict[str, Array], moves: bool) -> dict[str, str]:
    """How the channels were measured that only a part of the trace bears on.

    moves: whether the body does more than turn.
    """
    found = {}
    for field, channel in (("angular_velocity", "omega"), ("position", "position")):
        if partial(values := getattr(trace, field)):
            axes = [axis for axis, v in zip("xyz", values[0], strict=True) if not np.isnan(v)]
            found[channel] = f"{' and '.join(axes)} alone, the rest is not given"
    if "angular_momentum" in error and trace.orientation is None:
        found["angular_momentum"] = "its length alone, the attitude is not given"
    if "energy" in error and moves and rotation_alone(case.system, trace):
        found["energy"] = "of the rotation alone, the velocity is not given"
    return found


def rotation_alone(system: System, trace: Trace) -> bool:
    """Whether energy is compared as that of the rotation: without a velocity, or a whole one."""
    moving = trace.linear_velocity is not None and not partial(trace.linear_velocity)
    placed = trace.position is not None and not partial(trace.position)
    weighs = bool(np.any(system.load.gravity))
    return system.load.pivot is None and not (moving and (placed or not weighs))


def partial(vectors: Array | None) -> bool:
    """Whether vectors are given in some of their components only."""
    return vectors is not None and bool(np.any(np.isnan(vectors)))


def filled(trace: Trace, other: State) -> State:
    """The trace's states, with those of another motion at the same times where it gives none."""
    given = {name: getattr(trace, name) for name in vars(other)}
    return replace(
        other,
        **{
            name: np.where(np.isnan(own), getattr(other, name), own)
            for name, own in given.items()
            if own is not None
        },
    )


def measure_trace(case: Case, trace: Trace, truth: Truth) -> Measured:
    """The distances from the exact trajectory, and what of them digits and rounding account for."""
    absent, exact = absent_channels(trace, truth), truth.state
    state = filled(trace, exact)
    error = {c: distance(truth, trace, c, state, exact) for c in CHANNELS if c not in absent}
    moves = bool(np.any(exact.linear_velocity) or np.any(case.system.load.gravity))
    remarks = _remarks(case, trace, error, moves)
    opened = bounds_of(truth, trace, rotation_alone(case.system, trace))
    trajectory = exact_trajectory(case.system, case.initial)
    return Measured(case, trace, truth, trajectory, state, error, absent, remarks, *opened)


def distance(truth: Truth, trace: Trace, channel: str, one: State, other: State) -> Array:
    """(n,): as the yardstick has it, but for what the trace does not give.

    Momentum is compared by its length without an attitude, energy as that of the rotation without
    a velocity and, where there is weight, a position.
    """
    yardstick = truth.yardstick
    if channel == "energy" and rotation_alone(yardstick.system, trace):
        moved = {"position": other.position, "linear_velocity": other.linear_velocity}
        one = replace(one, **moved)
    if channel == "angular_momentum" and trace.orientation is None:
        sizes = [norm(angular_momentum(yardstick.system, state)) for state in (one, other)]
        return np.asarray(np.abs(sizes[0] - sizes[1]) / yardstick.sizes[channel])
    return yardstick.distance(channel, one, other)


def flips_of(found: Measured) -> list[Row]:
    """The largest error of a flip's time; none without omega, or where nothing flips.

    Both trajectories are interpolated alike between the trace's samples. What that leaves open is
    the cubic's own error, found half-way between the samples on the exact trajectory.
    """
    truth, times = found.truth, found.trace.times
    omega = found.trace.angular_velocity
    if omega is None or partial(omega) or len(times) < 3:
        return []
    exact = Hermite(truth.times, truth.state.angular_velocity, truth.omega_dot)
    middle = 0.5 * (times[1:] + times[:-1])
    gap = float(np.max(norm(exact.at(middle)[0] - found.trajectory(middle).angular_velocity)))
    rounding = found.rate * float(np.max(found.bound["omega"]))
    with np.errstate(all="ignore"):
        return flip_rows(found.case.system, exact, found.state, rounding + gap, rounding)
