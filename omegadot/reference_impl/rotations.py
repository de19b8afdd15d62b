"""Rotations as unit quaternions ``(w, x, y, z)``, world-from-body: section 2.2."""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.cross_product import skew as skew
from omegadot.reference_impl.system import Array

_CONJUGATE = np.array([1.0, -1.0, -1.0, -1.0])


def _product_table() -> Array:
    """Hamilton's table as a (4, 16) matrix: ``a @ table``, reshaped, is the matrix ``b -> a b``."""
    table = np.zeros((4, 4, 4))  # [factor a, row, factor b]
    for a, row, b, sign in (
        (0, 0, 0, 1), (1, 0, 1, -1), (2, 0, 2, -1), (3, 0, 3, -1),
        (0, 1, 1, 1), (1, 1, 0, 1), (2, 1, 3, 1), (3, 1, 2, -1),
        (0, 2, 2, 1), (2, 2, 0, 1), (3, 2, 1, 1), (1, 2, 3, -1),
        (0, 3, 3, 1), (3, 3, 0, 1), (1, 3, 2, 1), (2, 3, 1, -1),
    ):  # fmt: skip
        table[a, row, b] = sign
    return table.reshape(4, 16)


def _matrix_table() -> Array:
    """The (16, 9) matrix that takes the products ``q_i q_j`` to the rotation matrix's entries."""
    table = np.zeros((4, 4, 3, 3))
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        table[0, 0, i, i] = table[1 + i, 1 + i, i, i] = 1
        table[1 + j, 1 + j, i, i] = table[1 + k, 1 + k, i, i] = -1
        table[1 + i, 1 + j, i, j] = table[1 + i, 1 + j, j, i] = 2
        table[0, 1 + k, i, j], table[0, 1 + k, j, i] = -2, 2
    return table.reshape(16, 9)


_PRODUCT = _product_table()
_MATRIX = _matrix_table()


def quaternion_product(a: Array, b: Array) -> Array:
    """``a b`` by Hamilton's rule, (..., 4): the rotation b followed by the rotation a."""
    matrix = (a @ _PRODUCT).reshape(*a.shape, 4)
    product: Array = (matrix @ b[..., None])[..., 0]
    return product


def conjugate(q: Array) -> Array:
    """``q*``, (..., 4): the inverse rotation of a unit quaternion."""
    inverse: Array = q * _CONJUGATE
    return inverse


def normalize(q: Array) -> Array:
    """``q / |q|``, (..., 4)."""
    unit: Array = q / np.sqrt(np.add.reduce(q * q, -1, keepdims=True))
    return unit


def rotation_matrix(q: Array) -> Array:
    """``world_R_body``, (..., 3, 3), of a unit quaternion: ``p_world = world_R_body p_body``."""
    products = (q[..., :, None] * q[..., None, :]).reshape(*q.shape[:-1], 16)
    return (products @ _MATRIX).reshape(*q.shape[:-1], 3, 3)


def rotate(q: Array, v: Array) -> Array:
    """Body axes to world axes: ``world_R_body v``, (..., 3)."""
    rotated: Array = (rotation_matrix(q) @ v[..., None])[..., 0]
    return rotated


def rotate_inverse(q: Array, v: Array) -> Array:
    """World axes to body axes: ``world_R_body^T v``, (..., 3)."""
    rotated: Array = (v[..., None, :] @ rotation_matrix(q))[..., 0, :]
    return rotated


def exp_quaternion(rotation_vector: Array) -> Array:
    """The rotation by ``|r|`` rad about ``r``, (..., 3) to (..., 4): the exp of section 2.2.

    ``exp(r) = (cos(|r|/2), sin(|r|/2) r/|r|)``. Below 1e-18 rad the norm is held there, where
    ``sin(x/2)/x`` is one half to the last digit, so that zero needs no branch.
    """
    square = np.add.reduce(rotation_vector * rotation_vector, -1, keepdims=True)
    angle = np.sqrt(np.maximum(square, 1e-36))
    half = 0.5 * angle
    q = np.empty((*rotation_vector.shape[:-1], 4), rotation_vector.dtype)
    q[..., :1] = np.cos(half)
    q[..., 1:] = np.sin(half) / angle * rotation_vector
    return q


def turn_in_body(q: Array, w: Array, t: Array | float) -> Array:
    """``R(t) = R(0) exp(t w)`` with w (..., 3) in rad/s in the body frame. Section 2.2."""
    return quaternion_product(q, exp_quaternion(w * t))


def turn_in_world(q: Array, w: Array, t: Array | float) -> Array:
    """``R(t) = exp(t w) R(0)`` with w (..., 3) in rad/s in the world frame. Section 2.2."""
    return quaternion_product(exp_quaternion(w * t), q)


def rotation_between(q1: Array, q2: Array) -> Array:
    """The rotation vector r, (..., 3) rad, with ``q2 = q1 exp(r)`` up to sign; ``|r| <= pi``."""
    scalar, vector, sine = _relative(q1, q2)
    angle = 2 * np.arctan2(sine, np.abs(scalar))
    ratio = np.where(sine > 0, angle / np.maximum(sine, 1e-36), 2)
    between: Array = np.where(scalar < 0, -ratio, ratio) * vector
    return between


def attitude_angle(q1: Array, q2: Array) -> Array:
    """The angle in rad, (...), of the rotation from q1 to q2: ``2 atan2(|v|, |s|)``.

    Unlike ``2 arccos(q1 . q2)`` it resolves angles down to rounding.
    """
    scalar, _, sine = _relative(q1, q2)
    angle: Array = 2 * np.arctan2(sine, np.abs(scalar))[..., 0]
    return angle


def _relative(q1: Array, q2: Array) -> tuple[Array, Array, Array]:
    """Scalar s (..., 1), vector v (..., 3) and |v| (..., 1) of ``q1* q2``."""
    relative = quaternion_product(conjugate(q1), q2)
    vector = relative[..., 1:]
    return relative[..., :1], vector, np.sqrt(np.add.reduce(vector * vector, -1, keepdims=True))
