"""How the accelerations change with ω at fixed attitude, for linearly implicit schemes."""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.schemes.scheme import AccelerationOf
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array, State


def acceleration_and_jacobian(
    acceleration: AccelerationOf, state: State, size: Array | None = None
) -> tuple[Acceleration, Array, Array]:
    """Accelerations, ``∂ω̇/∂ω`` and ``∂a/∂ω``, the latter two (..., 3, 3), row by component.

    By central differences, in one call over seven states. Both accelerations are quadratic in ω
    (equation (8), and the pivot's ``ω × (ω × r)``), for which the central difference is exact at
    any distance; one as large as |ω| itself leaves the least rounding. size: (..., 1) rad/s, the
    distance where ω itself gives none, as at rest.
    """
    w = state.angular_velocity
    if size is None:
        size = np.sqrt(np.add.reduce(w * w, -1))[..., None]
    distance = np.where(size > 0, size, 1)  # rad/s; any does at rest
    moves = np.zeros((7, *(1,) * (w.ndim - 1), 3), w.dtype)
    for axis in range(3):
        moves[1 + axis, ..., axis], moves[4 + axis, ..., axis] = 1, -1
    spread = State(
        _repeat(state.orientation),
        w + distance * moves,
        _repeat(state.position),
        _repeat(state.linear_velocity),
    )
    found = acceleration(spread)
    here = Acceleration(found.angular[0], found.linear[0])
    return here, _columns(found.angular, distance), _columns(found.linear, distance)


def _repeat(field: Array) -> Array:
    return field[None].repeat(7, 0)  # on arrays this small faster than broadcast_to


def _columns(values: Array, distance: Array) -> Array:
    differences: Array = (values[1:4] - values[4:7]) / (2 * distance)
    return differences.transpose(*range(1, differences.ndim), 0)


def inverse_of_one_minus(matrix: Array) -> Array:
    """``(1 - M)⁻¹``, (..., 3, 3), in any precision.

    By cofactors, which are cross products of the columns: with a step that makes sense ``1 - M``
    is near the identity.
    """
    a = np.eye(3) - matrix
    c0, c1, c2 = a[..., 0], a[..., 1], a[..., 2]
    c12 = cross(c1, c2)
    determinant = np.add.reduce(c0 * c12, -1)[..., None, None]
    inverse: Array = np.stack([c12, cross(c2, c0), cross(c0, c1)], axis=-2) / determinant
    return inverse


def solve_one_minus(matrix: Array, right: Array) -> Array:
    """Solve ``(1 - M) x = b`` for x: (..., 3, 3) and (..., 3), in any precision."""
    return apply(inverse_of_one_minus(matrix), right)
