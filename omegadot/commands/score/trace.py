"""A trace in the project's own units and frames, with the resolution of its digits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.commands.score.attitude import attitude_of, group_of
from omegadot.commands.score.columns import Columns
from omegadot.commands.score.convention import Convention
from omegadot.commands.score.table import Column, Table, TraceError
from omegadot.gates.scales import norm
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import normalize, rotate, rotate_inverse
from omegadot.reference_impl.system import Array, System

# Of a motion, more than one instant is needed.
FEWEST_SAMPLES = 2


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
    times, open_times = _stamps(table, columns["t"], how)
    opened = {"times": open_times}
    attitude = attitude_of(table, columns, how)
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
            moved[name], opened[name] = _world(parts, how.scale_of("length"), how.world_axes)
    if how.point == "origin":
        moved = _to_center(table, system, moved, orientation, spins["angular_velocity"])
    return Trace(times, orientation, **spins, **moved, open=opened)


def _stacked(parts: list[Column], unit: float) -> tuple[Array, Array]:
    values = unit * np.stack([part.values for part in parts], axis=-1)
    return values, unit * norm(np.stack([part.open for part in parts], axis=-1))


def _spin(
    table: Table, parts: list[Column], unit: float, how: Convention, orientation: Array | None
) -> tuple[Array, Array]:
    """Angular velocity or omega-dot in body axes; both turn from the world alike."""
    values, opened = _stacked(parts, unit)
    if how.omega_frame == "body":
        return values @ how.body_axes.T, opened
    if orientation is None:
        raise TraceError(
            f"{table.file}: omega is in world axes and the attitude is not given, so it cannot be "
            "reported in body axes; map the attitude too."
        )
    return rotate_inverse(normalize(orientation), values @ how.world_axes.T), opened


def _world(parts: list[Column], unit: float, world: Array) -> tuple[Array, Array]:
    values, opened = _stacked(parts, unit)
    return values @ world.T, opened


def _stamps(table: Table, name: str, how: Convention) -> tuple[Array, Array]:
    """(n,) s from the scenario's start, and what is open of each. Raises TraceError."""
    column = table.column(name)
    unit, raw = how.scale_of("time"), column.values
    if len(raw) < FEWEST_SAMPLES:
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


def _to_center(
    table: Table,
    system: System,
    moved: dict[str, Array | None],
    orientation: Array | None,
    omega: Array | None,
) -> dict[str, Array | None]:
    """From the body's origin to its centre of mass: ``x + R c`` and ``v + R (omega x c)``."""
    c = system.body.center_of_mass
    position, velocity = moved["position"], moved["linear_velocity"]
    if not np.any(c):
        return moved
    needed = [orientation] if velocity is None else [orientation, omega]
    if position is None and velocity is None:
        return moved
    if orientation is None or any(part is None for part in needed):
        raise TraceError(
            f"{table.file}: it is the origin's position that is given, and the attitude or omega, "
            "which place the centre of mass, is not; map them too."
        )
    q = normalize(orientation)
    if position is not None:
        position = position + rotate(q, np.broadcast_to(c, position.shape))
    if velocity is not None and omega is not None:
        velocity = velocity + rotate(q, cross(omega, np.broadcast_to(c, omega.shape)))
    return {"position": position, "linear_velocity": velocity}
