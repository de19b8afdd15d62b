"""A trace in the project's own units and frames, with the resolution of its digits."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from omegadot.commands.score.attitude import attitude_of, world_turn
from omegadot.commands.score.settings import Reading
from omegadot.commands.score.stamps import check_rising
from omegadot.commands.score.table import TraceError
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import normalize, rotate, rotate_inverse
from omegadot.reference_impl.system import Array, System


@dataclass(frozen=True)
class Trace:
    """What a trace holds; None for what it does not give, NaN for single components of vectors.

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

    def at(self, rows: slice | NDArray[np.intp]) -> Trace:
        """Some of the samples."""
        given = {k: v[rows] for k, v in vars(self).items() if k != "open" and v is not None}
        return replace(self, **given, open={name: v[rows] for name, v in self.open.items()})


def trace_of(reading: Reading, system: System) -> Trace:
    """The trace read as the convention states. Raises TraceError."""
    how = reading.how
    check_rising(reading.table, reading.stamps)
    times, opened = reading.times, {"times": reading.stamps.open}
    moved = dict[str, Array]()
    attitude, orientation = attitude_of(reading), None
    if attitude is not None:
        orientation, opened["orientation"] = attitude
    for name, group in (("angular_velocity", "w"), ("omega_dot", "a")):
        if parts := reading.group(group):
            unit = how.scale_of("rate")
            bias = how.omega_bias if group == "w" else 0.0
            moved[name] = _in_body(reading, unit * parts[0] - bias, orientation)
            opened[name] = unit * norm(parts[1])
            if how.omega_frame == "world":
                opened[name] = opened[name] + norm(moved[name]) * opened["orientation"]
    for name, group in (("position", "p"), ("linear_velocity", "v")):
        if parts := reading.group(group):
            opened[name] = how.scale_of("length") * norm(parts[1])
            moved[name] = _in_world(reading, name, how.scale_of("length") * parts[0])
            if name == "linear_velocity" and np.any(how.world_rate):  # a part of it is the place's
                opened[name] = opened[name] + norm(how.world_rate) * opened["position"]
    trace = Trace(times, orientation, **moved, open=opened)
    return _at_center(reading, system, trace) if how.point == "origin" else trace


def turned(reading: Reading, values: Array, axes: Array) -> Array:
    """``axes @ v`` of vectors (n, 3), of which columns may be NaN. Raises TraceError.

    Such vectors can be taken to other axes only where these are the same ones in another order.
    """
    if not np.any(np.isnan(values)):
        return np.asarray(values @ axes.T)
    if not np.all(np.isin(axes, (-1.0, 0.0, 1.0))):
        raise TraceError(
            f"{reading.table.file}: a vector is given in some of its axes only, and the axes are "
            "turned; map all three of its components."
        )
    places = np.argmax(np.abs(axes), axis=1)
    return np.asarray(values[:, places] * axes[np.arange(3), places])


def _in_body(reading: Reading, values: Array, orientation: Array | None) -> Array:
    """Angular velocity or omega-dot in body axes; both turn from the world alike."""
    how = reading.how
    if how.omega_frame == "body":
        return turned(reading, values, how.body_axes)
    if orientation is None or np.any(np.isnan(values)):
        lacking = "the attitude" if orientation is None else "one of its components"
        raise TraceError(
            f"{reading.table.file}: omega is in world axes and {lacking} is not given, so it "
            "cannot be reported in body axes; map it too."
        )
    if np.any(how.world_rate):
        values = world_turn(reading).apply(values)
    return rotate_inverse(normalize(orientation), values @ how.world_axes.T)


def _in_world(reading: Reading, name: str, values: Array) -> Array:
    """Position or velocity in the scenario's world, ``x = W (exp(rate t) x' - origin)``.

    A velocity that is given in a turning world is the rate of change of the position in it.
    """
    how = reading.how
    if np.any(how.world_rate):
        if np.any(np.isnan(values)):
            raise TraceError(
                f"{reading.table.file}: a vector is given in some of its axes only, and the world "
                "turns; map all three of its components, or leave it out."
            )
        if name == "linear_velocity":
            places = reading.group("p")
            if places is None or np.any(np.isnan(places[0])):
                raise TraceError(
                    f"{reading.table.file}: the velocity is given in a world that turns, and the "
                    "position is not; map it too, or leave the velocity out with --column v=."
                )
            values = values + np.cross(how.world_rate, how.scale_of("length") * places[0])
        values = world_turn(reading).apply(values)
    origin = how.world_origin if name == "position" else np.zeros(3)
    return turned(reading, values - origin, how.world_axes)


def _at_center(reading: Reading, system: System, trace: Trace) -> Trace:
    """From the body's origin to its centre of mass: ``x + R c`` and ``v + R (omega x c)``."""
    c, omega = system.body.center_of_mass, trace.angular_velocity
    position, velocity = trace.position, trace.linear_velocity
    if omega is not None and np.any(np.isnan(omega)):
        omega = None
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
