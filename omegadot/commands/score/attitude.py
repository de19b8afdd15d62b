"""Quaternions, Euler angles and matrices to unit quaternions ``(w, x, y, z)``."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from omegadot.commands.score.settings import Reading
from omegadot.commands.score.table import Column, Table, TraceError
from omegadot.gates.scales import norm
from omegadot.reference_impl.rotations import conjugate, quaternion_product
from omegadot.reference_impl.system import Array

# Farther from a rotation than this it was misread; nearer, it has drifted, and that is measured.
MOST_OFF = 0.1
Angles = tuple[Array, Array]
"""(n, 4) quaternions as the trace has them, and (n,) rad, the resolution by their digits."""


def wxyz(rotation: Rotation) -> Array:
    """(..., 4), as the project writes quaternions."""
    found: Array = np.roll(rotation.as_quat(), 1, axis=-1)
    return found


def from_quaternions(table: Table, parts: list[Column]) -> Angles:
    """As they are: a length that drifts is an error of the simulator's. Raises TraceError."""
    q = np.stack([part.values for part in parts], axis=-1)
    off = np.abs(norm(q) - 1.0)
    worst = int(np.argmax(off))
    if off[worst] > MOST_OFF:
        raise TraceError(
            f"{table.file}: {table.place(worst)}: |q| is {norm(q)[worst]:.6g}, not 1; these are no "
            "unit quaternions."
        )
    return q, 2.0 * norm(np.stack([part.open for part in parts], axis=-1))


def from_euler(parts: list[Column], sequence: str, unit: float) -> Angles:
    """Three angles in the order of their sequence; their openings add up."""
    angles = unit * np.stack([part.values for part in parts], axis=-1)
    opening = unit * np.sum([part.open for part in parts], axis=0)
    return wxyz(Rotation.from_euler(sequence, angles)), np.asarray(opening)


def off_rotation(nine: Array) -> Array:
    """(n,): how far matrices, row by row in (n, 9), are off unit columns at right angles.

    At least 2 where one mirrors.
    """
    given = nine.reshape(-1, 3, 3)
    gram = np.abs(np.swapaxes(given, -1, -2) @ given - np.eye(3))
    mirrors = np.where(np.linalg.det(given) > 0.0, 0.0, 2.0)
    return np.asarray(np.maximum(np.max(gram, axis=(-1, -2)), mirrors))


def from_matrices(table: Table, parts: list[Column]) -> Angles:
    """The nearest rotations, by singular values.

    A matrix that is off by d in norm has its nearest rotation off by at most ``sqrt(2) d`` rad.
    Raises TraceError where a matrix is no rotation.
    """
    values = np.stack([part.values for part in parts], axis=-1)
    given, off = values.reshape(-1, 3, 3), off_rotation(values)
    worst = int(np.argmax(off))
    if off[worst] > MOST_OFF:
        raise TraceError(
            f"{table.file}: {table.place(worst)}: the nine numbers are no rotation matrix "
            f"(its columns are off unit length or right angles by {off[worst]:.2g})."
        )
    left, _, right = np.linalg.svd(given)
    opening = np.sqrt(2.0) * norm(np.stack([part.open for part in parts], axis=-1))
    return wxyz(Rotation.from_matrix(left @ right)), opening


def attitude_of(reading: Reading) -> Angles | None:
    """world_R_body between the scenario's axes, or None."""
    how = reading.how
    if parts := reading.group("q"):
        q, opening = from_quaternions(reading.table, parts)
    elif parts := reading.group("e"):
        q, opening = from_euler(parts, how.euler, how.scale_of("angle"))
    elif parts := reading.group("r"):
        q, opening = from_matrices(reading.table, parts)
    else:
        return None
    own = q if how.attitude_is == "world-from-body" else conjugate(q)
    return _in_our_axes(own, how.world_axes, how.body_axes), opening


def _in_our_axes(q: Array, world: Array, body: Array) -> Array:
    """``world q body^-1``, (n, 4): an attitude between their axes, reported between ours."""
    if np.array_equal(world, np.eye(3)) and np.array_equal(body, np.eye(3)):
        return q
    turns = [wxyz(Rotation.from_matrix(m)) for m in (world, body)]
    return quaternion_product(quaternion_product(turns[0], q), conjugate(turns[1]))
