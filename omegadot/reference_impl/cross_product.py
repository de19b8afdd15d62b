"""The cross product and its matrix: section 2.1, equations (1) and (2), and appendix 4.1."""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.system import Array

_NEXT = np.array([1, 2, 0])


def cross(a: Array, b: Array) -> Array:
    """``a × b``, (..., 3).

    Written without matrix products, so that ``cross(a, a)`` is exactly zero and one body and many
    round alike: fused multiply-adds of a matrix product keep neither.
    """
    product: Array = (a * b.take(_NEXT, -1) - a.take(_NEXT, -1) * b).take(_NEXT, -1)
    return product


def skew(w: Array) -> Array:
    """``w_×``, (..., 3, 3), the matrix with ``w_× p = w × p``. Equation (1).

    It is also the derivative of ``w × v`` by ``v``, equation (2).
    """
    matrix = np.zeros_like(w, shape=(*w.shape, 3))
    matrix[..., 0, 1] = -w[..., 2]
    matrix[..., 0, 2] = w[..., 1]
    matrix[..., 1, 0] = w[..., 2]
    matrix[..., 1, 2] = -w[..., 0]
    matrix[..., 2, 0] = -w[..., 1]
    matrix[..., 2, 1] = w[..., 0]
    return matrix


def skew_of_cross(a: Array, b: Array) -> Array:
    """``(a × b)_× = a_× b_× - b_× a_×``, (..., 3, 3). Jacobi's identity, sections 2.1 and 4.1."""
    a_x, b_x = skew(a), skew(b)
    product: Array = a_x @ b_x - b_x @ a_x
    return product


def nested_right(a: Array, b: Array, c: Array) -> Array:
    """``a × (b × c) = a_× b_× c``, (..., 3). Section 4.1, first line."""
    product: Array = (skew(a) @ skew(b) @ c[..., None])[..., 0]
    return product


def nested_left(a: Array, b: Array, c: Array) -> Array:
    """``(a × b) × c = (a_× b_× - b_× a_×) c``, (..., 3). Section 4.1, last line."""
    product: Array = (skew_of_cross(a, b) @ c[..., None])[..., 0]
    return product
