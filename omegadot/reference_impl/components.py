"""Vectors as their components: Python floats for a single body, arrays for lanes.

Formulas written in components serve both. A single body is then stepped by plain floats, several
times as fast as by NumPy on arrays of three, and lanes by one array operation a term, without a
matrix product a lane.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from omegadot.reference_impl.system import Array

Number = Any  # a float, or an array of lanes
_LEAST = 1e-18  # rad: below it sin(x/2)/x is one half to the last digit of any format


def apart(vector: Array) -> list[Number]:
    """The components (..., n) of a vector: n floats, or n arrays (...)."""
    if vector.ndim == 1:  # of long doubles these are no floats of Python's, and go as arrays do
        numbers: list[Number] = vector.tolist()
        return numbers
    return [vector[..., i] for i in range(vector.shape[-1])]


def together(parts: list[Number], like: Array) -> Array:
    """The vector (..., n) of n components, with the lanes and the number format of `like`.

    The last of them distinguishes floats from arrays; others may be constants of the system.
    """
    if type(parts[-1]) is float:
        return np.array(parts)
    vector = np.empty((*like.shape[:-1], len(parts)), like.dtype)
    for i, part in enumerate(parts):
        vector[..., i] = part
    return vector


def constants(values: Array) -> list[Number]:
    """The entries of a constant of a system, (..., 3) or (..., 3, 3), flat: floats or arrays."""
    square = values.shape[-2:] == (3, 3)
    flat = values.reshape(*values.shape[:-2], 9) if square else values
    return apart(np.asarray(flat))


def length(square: Number) -> Number:
    """``sqrt(square)``, held at 1e-18 from below so that it may divide."""
    if type(square) is float:
        return _LEAST if square < _LEAST * _LEAST else math.sqrt(square)
    return np.sqrt(np.maximum(square, _LEAST * _LEAST))


def half_turn(square: Number) -> tuple[Number, Number]:
    """``cos(a/2)`` and ``sin(a/2)/a`` of an angle given as its square; NaN if it is not finite."""
    if type(square) is float:
        angle = _LEAST if square < _LEAST * _LEAST else math.sqrt(square)
        try:
            return math.cos(0.5 * angle), math.sin(0.5 * angle) / angle
        except ValueError:
            return math.nan, math.nan
    angle = length(square)
    half = 0.5 * angle
    return np.cos(half), np.sin(half) / angle


def cos_sin(angle: Number) -> tuple[Number, Number]:
    """Cosine and sine; NaN of what is not finite."""
    if type(angle) is not float:
        return np.cos(angle), np.sin(angle)
    try:
        return math.cos(angle), math.sin(angle)
    except ValueError:
        return math.nan, math.nan


def arctan(x: Number) -> Number:
    """``atan(x)``."""
    return math.atan(x) if type(x) is float else np.arctan(x)


def cross3(
    ax: Number, ay: Number, az: Number, bx: Number, by: Number, bz: Number
) -> tuple[Number, Number, Number]:
    """``a × b``."""
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


def rotated(
    w: Number,
    x: Number,
    y: Number,
    z: Number,
    ax: Number,
    ay: Number,
    az: Number,
    twice: Number = 2.0,
) -> tuple[Number, Number, Number]:
    """``R a = a + 2 w (u × a) + 2 u × (u × a)`` of a unit quaternion (w, u): body to world axes.

    With -w in place of w it is ``Rᵀ a``. twice: ``2 / |q|²``, where q need not be unit.
    """
    bx, by, bz = twice * (y * az - z * ay), twice * (z * ax - x * az), twice * (x * ay - y * ax)
    return (
        ax + w * bx + (y * bz - z * by),
        ay + w * by + (z * bx - x * bz),
        az + w * bz + (x * by - y * bx),
    )
