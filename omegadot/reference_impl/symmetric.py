"""Products with, and inverses of, symmetric positive definite 3x3 matrices, in any precision."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from omegadot.reference_impl.arithmetic.components import Numbers, constants, one_in_components
from omegadot.reference_impl.arithmetic.precision import like, to_extended
from omegadot.reference_impl.system import Array

NOT_POSITIVE = "the inertia is not positive definite"


def apply(matrix: Array, vector: Array) -> Array:
    """``matrix @ vector``: (..., 3, 3) and (..., 3) to (..., 3), any leading axes."""
    product: Array = (matrix @ vector[..., None])[..., 0]
    return product


def times_symmetric(matrix: Array) -> Callable[[Array], Array]:
    """`apply` of one symmetric matrix (..., 3, 3), in components: a function of (..., 3)."""
    xx, xy, xz, _, yy, yz, _, _, zz = constants(matrix)

    @one_in_components
    def times(vector: Numbers) -> Numbers:
        x, y, z = vector
        return xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z

    return times


def inverse(matrix: Array) -> Array:
    """The inverse of a symmetric positive definite matrix, (..., 3, 3), in the matrix's precision.

    ``M = L D L^T`` with unit lower triangular L gives ``M^-1 = L^-T D^-1 L^-1``; elimination of a
    positive definite matrix is stable without pivoting, so the error is of the size
    ``eps * cond(M) * |M^-1|`` with the eps of the extended type. It is worked in that because
    ``numpy.linalg`` has none, and because an inertia of condition 1e6 then loses nothing in
    double. Raises ValueError where a pivot is not positive.
    """
    m = to_extended(matrix)
    if m.ndim == 2 and isinstance(m, np.ndarray):
        return like(matrix, _of_one(m))
    d1 = m[..., 0, 0]
    l21 = m[..., 1, 0] / d1
    l31 = m[..., 2, 0] / d1
    d2 = m[..., 1, 1] - l21 * m[..., 1, 0]
    s32 = m[..., 2, 1] - l31 * m[..., 1, 0]
    l32 = s32 / d2
    d3 = m[..., 2, 2] - l31 * m[..., 2, 0] - l32 * s32
    pivots = np.stack([d1, d2, d3], axis=-1)
    if not np.all(pivots > 0):
        raise ValueError(NOT_POSITIVE)
    w = np.zeros_like(m)  # L^-1
    w[..., 0, 0] = w[..., 1, 1] = w[..., 2, 2] = 1
    w[..., 1, 0] = -l21
    w[..., 2, 0] = l21 * l32 - l31
    w[..., 2, 1] = -l32
    return like(matrix, np.swapaxes(w, -1, -2) @ (w / pivots[..., None]))


def _of_one(m: Array) -> Array:
    """Of one matrix in long double: the same roundings number by number, in a third of the time."""
    (d1, _, _), (m21, m22, _), (m31, m32, m33) = m
    l21 = m21 / d1
    l31 = m31 / d1
    d2 = m22 - l21 * m21
    s32 = m32 - l31 * m21
    l32 = s32 / d2
    d3 = m33 - l31 * m31 - l32 * s32
    if not (d1 > 0 and d2 > 0 and d3 > 0):
        raise ValueError(NOT_POSITIVE)
    w21, w31, w32 = -l21, l21 * l32 - l31, -l32
    q11, q21, q22 = 1 / d1, w21 / d2, 1 / d2
    q31, q32, q33 = w31 / d3, w32 / d3, 1 / d3
    found = [
        [q11 + w21 * q21 + w31 * q31, w21 * q22 + w31 * q32, w31 * q33],
        [q21 + w32 * q31, q22 + w32 * q32, w32 * q33],
        [q31, q32, q33],
    ]
    return np.array(found) + 0.0  # no negative zeros: a product's sums begin at zero
