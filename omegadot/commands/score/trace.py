"""A trace in the project's own units and frames, with the resolution of its digits."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from omegadot.commands.score.attitude import attitude_of
from omegadot.commands.score.settings import Reading
from omegadot.commands.score.table import TraceError
from omegadot.gates.scales import norm
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import normalize, rotate, rotate_inverse
from omegadot.reference_impl.system import Array, System


@dataclass(frozen=True)
class Trace:
    """What a trace holds; None for what it does not give.

    times: (n,) s.  orientation: (n, 4).  angular_velocity: (n, 3) rad/s, body.  position and
    linear_velocity: (n, 3) of the centre of mass, world.  omega_dot: (n, 3) rad/s^2, body.
    open: (n,) by field (``times`` too), how far the true number may lie from the printed one;
    the orientation's in rad.
    """

    times: Array
    orientation: Array | None
    angular_velocity: Array | None = None
    position: Array | None = None
    linear_velocity: Array | None = None
    omega_dot: Array | None = None
    open: dict[str, Array] = field(default_factory=dict)


def trace_of(reading: Reading, system: System) -> Trace:
    """The trace read as the convention states. Raises TraceError."""
    how = reading.how
    times, open_times = _stamps(reading)
    opened, moved = {"times": open_times}, dict[str, Array]()
    attitude, orientation = attitude_of(reading), None
    if attitude is not None:
        orientation, opened["orientation"] = attitude
    for name, group in (("angular_velocity", "w"), ("omega_dot", "a")):
        if parts := reading.group(group):
            unit = how.scale_of("rate")
            moved[name] = _in_body(reading, unit * parts[0], orientation)
            opened[name] = unit * norm(parts[1])
            if how.omega_frame == "world":
                opened[name] = opened[name] + norm(moved[name]) * opened["orientation"]
    for name, group in (("position", "p"), ("linear_velocity", "v")):
        if parts := reading.group(group):
            unit = how.scale_of("length")
            moved[name], opened[name] = unit * parts[0] @ how.world_axes.T, unit * norm(parts[1])
    trace = Trace(times, orientation, **moved, open=opened)
    return _at_center(reading, system, trace) if how.point == "origin" else trace


def _in_body(reading: Reading, values: Array, orientation: Array | None) -> Array:
    """Angular velocity or omega-dot in body axes; both turn from the world alike."""
    how = reading.how
    if how.omega_frame == "body":
        return values @ how.body_axes.T
    if orientation is None:
        raise TraceError(
            f"{reading.table.file}: omega is in world axes and the attitude is not given, so it "
            "cannot be reported in body axes; map the attitude too."
        )
    return rotate_inverse(normalize(orientation), values @ how.world_axes.T)


def _at_center(reading: Reading, system: System, trace: Trace) -> Trace:
    """From the body's origin to its centre of mass: ``x + R c`` and ``v + R (omega x c)``."""
    c, omega = system.body.center_of_mass, trace.angular_velocity
    position, velocity = trace.position, trace.linear_velocity
    if not np.any(c) or (position is None and velocity is None):
        return trace
    if trace.orientation is None or (velocity is not None and omega is None):
        raise TraceError(
            f"{reading.table.file}: it is the origin's position that is given, and the attitude or "
            "omega, which place the centre of mass, is not; map them too."
        )
    q = normalize(trace.orientation)
    if position is not None:
        position = position + rotate(q, np.broadcast_to(c, position.shape))
    if velocity is not None and omega is not None:
        velocity = velocity + rotate(q, cross(omega, np.broadcast_to(c, omega.shape)))
    return replace(trace, position=position, linear_velocity=velocity)


def _stamps(reading: Reading) -> tuple[Array, Array]:
    """(n,) s from the scenario's start, and what is open of each. Raises TraceError."""
    table, how = reading.table, reading.how
    column = table.column(reading.columns["t"])
    unit, raw = how.scale_of("time"), column.values
    if len(raw) < 2:  # of a motion, more than one instant is needed
        raise TraceError(f"{table.file}: has one sample only; give a trace with at least two.")
    gaps = np.diff(raw)
    repeated, back = np.flatnonzero(gaps == 0.0), np.flatnonzero(gaps < 0.0)
    if len(back):
        k, more = int(back[0]), len(back) - 1
        raise TraceError(
            f"{table.file}: {table.place(k + 1)}: the time goes back from {raw[k]:g} to "
            f"{raw[k + 1]:g}{_more(more)}; sort the samples."
        )
    if len(repeated):
        k, more = int(repeated[0]), len(repeated) - 1
        raise TraceError(
            f"{table.file}: {table.place(k)} and {table.place(k + 1)}: the time {raw[k]:g} is "
            f"repeated{_more(more)}; keep one sample of each instant."
        )
    return unit * raw - how.time_offset, unit * column.open_time


def _more(count: int) -> str:
    return f", and {count} times more" if count else ""
