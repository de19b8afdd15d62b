"""Semi-implicit Euler as DART takes it: turns below 1e-3 rad are expanded to second order."""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.cross_product import skew
from omegadot.reference_impl.rotations import (
    conjugate,
    exp_quaternion,
    normalize,
    quaternion_product,
    rotation_matrix,
)
from omegadot.reference_impl.schemes.motion import Motion
from omegadot.reference_impl.schemes.scheme import IN_WORLD, FormulaChange, Scheme, every_channel
from omegadot.reference_impl.system import Array

SHORT = 1e-3  # rad
# The attitude of the joint's frame in the world, 120 degrees about (1, 1, 1): in which frame a
# matrix is read makes a difference where it is not quite a rotation.
FRAME = np.full(4, 0.5)


def quaternion_read(matrix: Array) -> Array:
    """The unit quaternion, (..., 4), that Eigen reads from a matrix (..., 3, 3).

    Four times a component times the quaternion is a row of sums and differences of the matrix's
    entries: the scalar's where the trace is positive, else that of the largest diagonal entry. The
    four rows agree for a rotation; for what is near one, the choice makes a difference.
    """
    m = matrix
    x, y, z = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    wx, wy, wz = (m[..., j, i] - m[..., i, j] for i, j in ((1, 2), (2, 0), (0, 1)))
    xy, yz, zx = (m[..., j, i] + m[..., i, j] for i, j in ((0, 1), (1, 2), (2, 0)))
    rows = [
        np.stack(row, -1)
        for row in (
            (1 + x + y + z, wx, wy, wz),
            (wx, 1 + x - y - z, xy, zx),
            (wy, xy, 1 - x + y - z, yz),
            (wz, zx, yz, 1 - x - y + z),
        )
    ]
    largest = 1 + np.argmax(np.stack((x, y, z), -1), -1)
    which = np.where(x + y + z > 0, 0, largest)[..., None]
    found: Array = np.select([which == k for k in range(4)], rows, rows[0])
    return normalize(found)


def _turned_short(q: Array, rotation_vector: Array) -> Array:
    """``q (1 + [r] + [r]²/2)``, (..., 4), read as a quaternion in the joint's frame.

    It turns by ``|r|³/6`` too far, and is off orthogonality by ``|r|⁴/4``.
    """
    r = skew(rotation_vector)
    off = rotation_matrix(quaternion_product(conjugate(FRAME), q)) @ (np.eye(3) + r + 0.5 * r @ r)
    found = quaternion_product(FRAME, quaternion_read(off))
    same = np.add.reduce(found * q, -1, keepdims=True) >= 0  # of two signs, the one q has
    return np.where(same, found, -found)


def _turned(q: Array, rotation_vector: Array) -> Array:
    """The attitude turned by r in the body frame: expanded below 1e-3 rad, else by ``exp r``."""
    exact = quaternion_product(q, exp_quaternion(rotation_vector))
    short = np.add.reduce(rotation_vector * rotation_vector, -1, keepdims=True) < SHORT * SHORT
    if not np.any(short):
        return exact
    return np.where(short, _turned_short(q, rotation_vector), exact)


def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    """As semi-implicit Euler, the attitude by the turn above."""
    v = v + h * motion.acceleration(q, v)
    if motion.turned_by is None:
        return motion.retract(q, h * v), v
    return motion.turned_by(_turned, q, h * v), v


SCHEME = Scheme(
    name="semi-implicit-euler-short-turns",
    title="Semi-implicit Euler, turns below 1e-3 rad expanded to second order",
    step=step,
    orders=every_channel(1),
    special={"free": {"linear_momentum": None}},
    source="DART (dart/math/Geometry.cpp, expMapRot and logMap), confirmed by its steps",
    coordinates=IN_WORLD,
    change=FormulaChange(SHORT, SHORT**3 / 6 + SHORT**4 / 4),  # see `_turned_short`
)
