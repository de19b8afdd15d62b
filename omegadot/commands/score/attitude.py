"""Quaternions, Euler angles and matrices to unit quaternions ``(w, x, y, z)``."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from omegadot.commands.score.settings import Reading
from omegadot.commands.score.table import Table, TraceError
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.rotations import conjugate, quaternion_product
from omegadot.reference_impl.system import Array
from omegadot.written import written

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation

# Farther from a rotation than this it was misread; nearer, it has drifted, and that is measured.
MOST_OFF = 0.1
Angles = tuple[Array, Array]
"""(n, 4) quaternions as the trace has them, and (n,) rad, the resolution by their digits."""


def wxyz(rotation: Rotation) -> Array:
    """(..., 4), as the project writes quaternions."""
    found: Array = np.roll(rotation.as_quat(), 1, axis=-1)
    return found


def of_matrix(matrix: Array) -> Array:
    """(..., 4), of rotation matrices (..., 3, 3)."""
    from scipy.spatial.transform import Rotation  # most logs go without it, and it imports slowly

    return wxyz(Rotation.from_matrix(matrix))


def _of_angles(order: str, angles: Array) -> Array:
    from scipy.spatial.transform import Rotation

    return wxyz(Rotation.from_euler(order, angles))


def _from_quaternions(table: Table, q: Array, opened: Array) -> Angles:
    """As they are: a length that drifts is an error of the simulator's. Raises TraceError."""
    off = np.abs(norm(q) - 1.0)
    worst = int(np.argmax(off))
    if off[worst] > MOST_OFF:
        raise TraceError(
            f"{table.file}: {table.place(worst)}: |q| is {written(norm(q)[worst])}, not 1; "
            "these are no "
            "unit quaternions."
        )
    return q, 2.0 * norm(opened)


def off_rotation(nine: Array) -> Array:
    """(n,): how far matrices, row by row in (n, 9), are off unit columns at right angles.

    At least 2 where one mirrors.
    """
    given = nine.reshape(-1, 3, 3)
    gram = np.abs(np.swapaxes(given, -1, -2) @ given - np.eye(3))
    mirrors = np.where(np.linalg.det(given) > 0.0, 0.0, 2.0)
    return np.asarray(np.maximum(np.max(gram, axis=(-1, -2)), mirrors))


def _from_matrices(table: Table, nine: Array, opened: Array) -> Angles:
    """The nearest rotations, by singular values.

    A matrix that is off by d in norm has its nearest rotation off by at most ``sqrt(2) d`` rad.
    Raises TraceError where a matrix is no rotation.
    """
    off = off_rotation(nine)
    worst = int(np.argmax(off))
    if off[worst] > MOST_OFF:
        raise TraceError(
            f"{table.file}: {table.place(worst)}: the nine numbers are no rotation matrix "
            f"(its columns are off unit length or right angles by {written(off[worst], 2)})."
        )
    left, _, right = np.linalg.svd(nine.reshape(-1, 3, 3))
    return of_matrix(left @ right), np.sqrt(2.0) * norm(opened)


def attitude_of(reading: Reading) -> Angles | None:
    """world_R_body between the scenario's axes, or None."""
    how = reading.how
    if parts := reading.group("q"):
        q, opened = _from_quaternions(reading.table, *parts)
    elif parts := reading.group("e"):
        unit = how.scale_of("angle")
        q = _of_angles(how.euler, unit * parts[0])
        opened = np.asarray(unit * np.sum(parts[1], axis=-1))  # the openings add up
    elif parts := reading.group("r"):
        q, opened = _from_matrices(reading.table, *parts)
    else:
        return None
    if how.attitude_is == "body-from-world":
        q = conjugate(q)
    if np.any(how.world_rate):
        q = quaternion_product(wxyz(world_turn(reading)), q)
    axes = (how.world_axes, how.body_axes)
    if not all(np.array_equal(turned, np.eye(3)) for turned in axes):
        world, body = (of_matrix(turned) for turned in axes)
        q = quaternion_product(quaternion_product(world, q), conjugate(body))
    return q, opened


def world_turn(reading: Reading) -> Rotation:
    """How far the trace's world has turned at each sample since the start: ``exp(rate t)``."""
    from scipy.spatial.transform import Rotation

    return Rotation.from_rotvec(reading.times[:, None] * reading.how.world_rate)
