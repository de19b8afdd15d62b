"""Vectors as their components: Python floats for a single body, arrays for lanes.

Formulas written in components serve both. A single body is then stepped by plain floats, several
times as fast as by NumPy on arrays of three, and lanes by one array operation a term, without a
matrix product a lane.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import wraps
from math import atan, atan2, cos, nan, sin, sqrt
from typing import Any

import numpy as np

from omegadot.reference_impl.system import Array

Number = Any  # a float, or an array of lanes
Numbers = Sequence[Number]  # the components of a vector
Formula = Callable[[Numbers, Numbers], Numbers]
_LEAST = 1e-18  # rad: below it sin(x/2)/x is one half to the last digit of any format


def apart(vector: Array) -> list[Number]:
    """The components (..., n) of a vector: n floats, or n arrays (...)."""
    if vector.ndim == 1:  # of long doubles these are no floats of Python's, and go as arrays do
        numbers: list[Number] = vector.tolist()
        return numbers
    return [vector[..., i] for i in range(vector.shape[-1])]


def together(parts: Numbers, like: Array) -> Array:
    """The vector (..., n) of n components, with the lanes and the number format of `like`.

    Components may be constants of the system.
    """
    if like.ndim == 1:
        return np.array(parts, like.dtype)
    vector = _empty(like.shape[:-1], len(parts), like.dtype)
    for i, part in enumerate(parts):
        vector[..., i] = part
    return vector


def in_lanes(vector: Array, lanes: tuple[int, ...]) -> Array:
    """A vector (..., n) for each of these lanes, kept as `together` keeps its vectors."""
    copy = _empty(lanes, vector.shape[-1], vector.dtype)
    copy[...] = vector
    return copy


def _empty(lanes: tuple[int, ...], count: int, dtype: Any) -> Array:
    """(..., n), with each component in one piece in memory, as formulas read it."""
    components: Array = np.empty((count, *lanes), dtype)
    return components.transpose(*range(1, components.ndim), 0)


def in_components(formula: Formula) -> Callable[[Array, Array], Array]:
    """A formula over the components of two vectors as a function of the vectors, (..., n)."""

    @wraps(formula)
    def of_vectors(first: Array, second: Array) -> Array:
        if second.ndim == 1:  # as below, without the calls
            return np.array(formula(first.tolist(), second.tolist()), second.dtype)
        return together(formula(apart(first), apart(second)), second)

    of_vectors.formula = formula  # type: ignore[attr-defined]
    return of_vectors


def one_in_components(formula: Callable[[Numbers], Numbers]) -> Callable[[Array], Array]:
    """As `in_components`, of one vector."""

    @wraps(formula)
    def of_vector(vector: Array) -> Array:
        return together(formula(apart(vector)), vector)

    of_vector.formula = formula  # type: ignore[attr-defined]
    return of_vector


def formulas_of(*functions: Callable[..., Array]) -> list[Any] | None:
    """The formulas of which `in_components` made these functions; None where one is another."""
    formulas = [getattr(function, "formula", None) for function in functions]
    return None if None in formulas else formulas


def constants(values: Array) -> list[Number]:
    """The entries of a constant of a system, (..., 3) or (..., 3, 3), flat: floats or arrays."""
    square = values.shape[-2:] == (3, 3)
    flat = values.reshape(*values.shape[:-2], 9) if square else values
    return apart(np.asarray(flat))


def length(square: Number) -> Number:
    """``sqrt(square)``, held at 1e-18 from below so that it may divide."""
    if type(square) is float:
        return _LEAST if square < _LEAST * _LEAST else sqrt(square)
    return np.sqrt(np.maximum(square, _LEAST * _LEAST))


def half_turn(square: Number) -> tuple[Number, Number]:
    """``cos(a/2)`` and ``sin(a/2)/a`` of an angle given as its square; NaN if it is not finite."""
    if type(square) is float:
        angle = _LEAST if square < _LEAST * _LEAST else sqrt(square)
        try:
            return cos(0.5 * angle), sin(0.5 * angle) / angle
        except ValueError:
            return nan, nan
    angle = length(square)
    half = 0.5 * angle
    return np.cos(half), np.sin(half) / angle


def arctan(x: Number) -> Number:
    """``atan(x)``."""
    return atan(x) if type(x) is float else np.arctan(x)


def arctan2(y: Number, x: Number) -> Number:
    """The angle of the point (x, y)."""
    return atan2(y, x) if type(y) is float and type(x) is float else np.arctan2(y, x)


def cosine_and_sine(angle: Number) -> tuple[Number, Number]:
    """Of an angle; NaN if it is not finite."""
    if type(angle) is float:
        try:
            return cos(angle), sin(angle)
        except ValueError:
            return nan, nan
    return np.cos(angle), np.sin(angle)


def product4(a: Numbers, b: Numbers) -> list[Number]:
    """``a b`` of two quaternions (w, x, y, z), by Hamilton's rule."""
    w, x, y, z = a
    p, q, r, s = b
    return [
        w * p - x * q - y * r - z * s,
        w * q + x * p + y * s - z * r,
        w * r - x * s + y * p + z * q,
        w * s + x * r - y * q + z * p,
    ]


def cross3(a: Numbers, b: Numbers) -> tuple[Number, Number, Number]:
    """``a × b``."""
    ax, ay, az = a
    bx, by, bz = b
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


def rotated(q: Numbers, a: Numbers, twice: Number = 2.0) -> tuple[Number, Number, Number]:
    """``R a = a + 2 w (u × a) + 2 u × (u × a)`` of a unit quaternion (w, u): body to world axes.

    With -w in place of w it is ``Rᵀ a``. twice: ``2 / |q|²``, where q need not be unit.
    """
    w, x, y, z = q
    ax, ay, az = a
    bx, by, bz = twice * (y * az - z * ay), twice * (z * ax - x * az), twice * (x * ay - y * ax)
    return (
        ax + w * bx + (y * bz - z * by),
        ay + w * by + (z * bx - x * bz),
        az + w * bz + (x * by - y * bx),
    )
