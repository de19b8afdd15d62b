"""A trace in the project's own units and frames, with the resolution of its digits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.commands.score.attitude import (
    Angles,
    from_euler,
    from_matrices,
    from_quaternions,
    group_of,
)
from omegadot.commands.score.center import to_center
from omegadot.commands.score.columns import Columns
from omegadot.commands.score.convention import Convention
from omegadot.commands.score.stamps import stamps_of
from omegadot.commands.score.table import Column, Table, TraceError
from omegadot.gates.scales import norm
from omegadot.reference_impl.rotations import (
    conjugate,
    normalize,
    quaternion_product,
    rotate_inverse,
)
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
    angular_velocity: Array | None
    position: Array | None
    linear_velocity: Array | None
    omega_dot: Array | None
    open: dict[str, Array]


def trace_of(table: Table, columns: Columns, how: Convention, system: System) -> Trace:
    """The trace read as the convention states. Raises TraceError."""
    times, open_times = stamps_of(table, columns["t"], how)
    opened = {"times": open_times}
    attitude = _attitude(table, columns, how)
    orientation = None
    if attitude is not None:
        orientation, opened["orientation"] = attitude
    spins: dict[str, Array | None] = {"angular_velocity": None, "omega_dot": None}
    for name, group in (("angular_velocity", "w"), ("omega_dot", "a")):
        parts = group_of(table, columns, group)
        if parts:
            spin, rounding = _spin(table, parts, how.scale_of("rate"), how, orientation)
            if how.omega_frame == "world":
                rounding = rounding + norm(spin) * opened["orientation"]
            spins[name], opened[name] = spin, rounding
    moved: dict[str, Array | None] = {"position": None, "linear_velocity": None}
    for name, group in (("position", "p"), ("linear_velocity", "v")):
        parts = group_of(table, columns, group)
        if parts:
            moved[name], opened[name] = _world(parts, how.scale_of("length"), how.world)
    if how.point == "origin":
        moved = to_center(table, system, moved, orientation, spins["angular_velocity"])
    return Trace(times, orientation, **spins, **moved, open=opened)


def _attitude(table: Table, columns: Columns, how: Convention) -> Angles | None:
    """world_R_body between the scenario's axes, or None."""
    found: Angles | None = None
    if parts := group_of(table, columns, "q"):
        found = from_quaternions(table, parts)
    elif parts := group_of(table, columns, "e"):
        found = from_euler(parts, how.euler, how.scale_of("angle"))
    elif parts := group_of(table, columns, "r"):
        found = from_matrices(table, parts)
    if found is None:
        return None
    q = found[0] if how.attitude == "world-from-body" else conjugate(found[0])
    return in_our_axes(q, how.world, how.body), found[1]


def in_our_axes(q: Array, world: Array, body: Array) -> Array:
    """``world q body^-1``, (n, 4): an attitude between their axes, reported between ours."""
    if np.array_equal(world, np.eye(3)) and np.array_equal(body, np.eye(3)):
        return q
    from scipy.spatial.transform import Rotation

    turns = [np.roll(Rotation.from_matrix(m).as_quat(), 1) for m in (world, body)]
    return quaternion_product(quaternion_product(turns[0], q), conjugate(turns[1]))


def _stacked(parts: list[Column], unit: float) -> tuple[Array, Array]:
    values = unit * np.stack([part.values for part in parts], axis=-1)
    return values, unit * norm(np.stack([part.open for part in parts], axis=-1))


def _spin(
    table: Table, parts: list[Column], unit: float, how: Convention, orientation: Array | None
) -> tuple[Array, Array]:
    """Angular velocity or omega-dot in body axes; both turn from the world alike."""
    values, opened = _stacked(parts, unit)
    if how.omega_frame == "body":
        return values @ how.body.T, opened
    if orientation is None:
        raise TraceError(
            f"{table.file}: omega is in world axes and the attitude is not given, so it cannot be "
            "reported in body axes; map the attitude too."
        )
    return rotate_inverse(normalize(orientation), values @ how.world.T), opened


def _world(parts: list[Column], unit: float, world: Array) -> tuple[Array, Array]:
    values, opened = _stacked(parts, unit)
    return values @ world.T, opened
