"""How the accelerations change with the velocities at fixed q, for linearly implicit schemes."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np

from omegadot.reference_impl.arithmetic.components import in_lanes
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.schemes.motion import Motion, Velocity
from omegadot.reference_impl.system import Array

_DOUBLE = np.dtype(float)


def acceleration_and_jacobian(
    motion: Motion, q: Array, v: Array, size: Array | None = None
) -> tuple[Array, Array]:
    """``v̇`` (..., n) and ``∂v̇/∂v`` (..., n, m), row by component: see `Motion`."""
    if motion.jacobian is not None:
        return motion.jacobian(q, v, size)
    return by_differences(motion.acceleration, q, v, v.shape[-1], size)


def by_differences(
    acceleration: Velocity, q: Array, v: Array, last: int, size: Array | None
) -> tuple[Array, Array]:
    """Accelerations and their derivatives by the last m velocities, at 2 m + 1 states.

    Accelerations are quadratic in v (equation (8), and a pivot's ``ω × (ω × r)``), for which the
    central difference is exact at any distance; one as large as those velocities leaves the least
    rounding. size: (..., 1), the distance where v itself gives none, as at rest.
    """
    if size is None:
        moving = v[..., -last:]
        size = np.sqrt(np.add.reduce(moving * moving, -1))[..., None]
    distance = np.where(size > 0, size, 1)  # any does at rest
    moves = _moves(last, v.shape[-1])
    if v.ndim == 1:  # one call each is quicker, and need not broadcast
        found = np.array([acceleration(q, w).copy() for w in v + distance * moves])
    else:
        moves = moves.reshape(len(moves), *(1,) * (v.ndim - 1), v.shape[-1])
        lanes = (len(moves), *v.shape[:-1])
        found = acceleration(in_lanes(q, lanes), in_lanes(v + distance * moves, lanes))
    slopes: Array = (found[1 : last + 1] - found[last + 1 :]) / (2 * distance)
    return found[0], slopes.transpose(*range(1, slopes.ndim), 0)


@cache
def _moves(last: int, count: int) -> Array:
    """No move, then one forth along each of the last axes, then one back: (2 last + 1, count)."""
    forth = np.eye(count)[count - last :]
    return np.concatenate((np.zeros((1, count)), forth, -forth))


def natural_size(motion: Motion, v: Array, a: Array) -> Array:
    """(..., 1) rad/s: ``(|ω|² + |ω̇|)^½``, at which what depends on ω is as large as what does not.

    Unlike any constant it scales with the unit of time.
    """
    w, w_dot = v[..., motion.spin], a[..., motion.spin]
    spin, pull = np.add.reduce(w * w, -1), np.add.reduce(w_dot * w_dot, -1)
    size: Array = np.sqrt(spin + np.sqrt(pull))[..., None]
    return size


def solve_one_minus(matrix: Array, right: Array) -> Array:
    """The x with ``(1 - M) x = b``, (..., n), in any precision: see `solver_of_one_minus`."""
    if matrix.ndim == 2 and matrix.shape[0] == matrix.shape[1] and matrix.dtype == _DOUBLE:
        try:  # an inverse, for one right-hand side, takes a quarter longer
            return np.linalg.solve(_eye(len(matrix)) - matrix, right)
        except np.linalg.LinAlgError:
            return np.full_like(right, np.nan)
    return solver_of_one_minus(matrix)(right)


def solver_of_one_minus(matrix: Array) -> Callable[[Array], Array]:
    """What solves ``(1 - M) x = b`` for x, (..., n) to (..., n), in any precision.

    matrix: (..., n, m), the last m columns of M; the others are zero.
    """
    m = matrix.shape[-1]
    inverse = _inverse(_eye(m) - matrix[..., -m:, :])
    if matrix.shape == (m, m):
        return inverse.__matmul__
    if matrix.shape[-2] == m:
        return lambda b: (inverse @ b[..., None])[..., 0]
    rest = matrix[..., :-m, :]

    def solve(b: Array) -> Array:
        x = inverse @ b[..., -m:, None]
        first: Array = b[..., :-m] + (rest @ x)[..., 0]
        return np.concatenate((first, x[..., 0]), axis=-1)

    return solve


@cache
def _eye(count: int) -> Array:
    return np.eye(count)


def _inverse(a: Array) -> Array:
    """``A⁻¹``, (..., m, m); NaN or infinite where there is none.

    With a step that makes sense A is near the identity. LAPACK knows doubles alone, and a call of
    it a matrix; lanes of 3x3 are inverted by cofactors, which are cross products of the columns,
    and what is longer than a double by one step of Newton's from a double's inverse.
    """
    if a.shape[-1] == 3 and (a.ndim > 2 or a.dtype != _DOUBLE):
        c0, c1, c2 = a[..., 0], a[..., 1], a[..., 2]
        c12 = cross(c1, c2)
        determinant = np.add.reduce(c0 * c12, -1)[..., None, None]
        adjugate: Array = np.stack([c12, cross(c2, c0), cross(c0, c1)], axis=-2)
        cofactors: Array = adjugate / determinant
        return cofactors
    try:
        inverse: Array = np.linalg.inv(a.astype(float, copy=False))
    except np.linalg.LinAlgError:
        lanes = a.reshape(-1, *a.shape[-2:])
        if len(lanes) == 1:
            return np.full_like(a, np.nan)
        return np.array([_inverse(one) for one in lanes]).reshape(a.shape)
    return (
        inverse if a.dtype == inverse.dtype else inverse @ (2 * np.eye(a.shape[-1]) - a @ inverse)
    )
