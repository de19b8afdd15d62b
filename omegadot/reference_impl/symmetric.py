"""Products with, and inverses of, symmetric positive definite 3x3 matrices, in any precision."""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.arithmetic.precision import like, to_extended
from omegadot.reference_impl.system import Array


def apply(matrix: Array, vector: Array) -> Array:
    """``matrix @ vector``: (..., 3, 3) and (..., 3) to (..., 3), any leading axes."""
    product: Array = (matrix @ vector[..., None])[..., 0]
    return product


def inverse(matrix: Array) -> Array:
    """The inverse of a symmetric positive definite matrix, (..., 3, 3), in the matrix's precision.

    ``M = L D L^T`` with unit lower triangular L gives ``M^-1 = L^-T D^-1 L^-1``; elimination of a
    positive definite matrix is stable without pivoting, so the error is of the size
    ``eps * cond(M) * |M^-1|`` with the eps of the extended type. It is worked in that because
    ``numpy.linalg`` has none, and because an inertia of condition 1e6 then loses nothing in
    double. Raises ValueError where a pivot is not positive.
    """
    m = to_extended(matrix)
    d1 = m[..., 0, 0]
    l21 = m[..., 1, 0] / d1
    l31 = m[..., 2, 0] / d1
    d2 = m[..., 1, 1] - l21 * m[..., 1, 0]
    s32 = m[..., 2, 1] - l31 * m[..., 1, 0]
    l32 = s32 / d2
    d3 = m[..., 2, 2] - l31 * m[..., 2, 0] - l32 * s32
    pivots = np.stack([d1, d2, d3], axis=-1)
    if not np.all(pivots > 0):
        raise ValueError("the inertia is not positive definite")
    w = np.zeros_like(m)  # L^-1
    w[..., 0, 0] = w[..., 1, 1] = w[..., 2, 2] = 1
    w[..., 1, 0] = -l21
    w[..., 2, 0] = l21 * l32 - l31
    w[..., 2, 1] = -l32
    return like(matrix, np.swapaxes(w, -1, -2) @ (w / pivots[..., None]))
