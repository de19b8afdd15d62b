"""Modified Rodrigues parameters, in which Basilisk keeps an attitude.

``sigma = tan(angle / 4) axis``, of the turn from world to body axes. Each attitude has two, sigma
and its shadow ``-sigma / |sigma|^2``; the shorter one is of half a turn at most. Schaub, Junkins,
Analytical Mechanics of Space Systems, section 3.5.
"""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.system import Array


def of_quaternion(q: Array) -> Array:
    """The shorter sigma, (..., 3), of a quaternion (w, x, y, z), (..., 4): ``v / (1 + w)``."""
    unit = normalize(np.array(q, float))
    unit = np.where(unit[..., :1] < 0, -unit, unit)
    shorter: Array = unit[..., 1:] / (1 + unit[..., :1])
    return shorter


def quaternion_of(sigma: Array) -> Array:
    """The unit quaternion, (..., 4): ``(1 - |sigma|^2, 2 sigma) / (1 + |sigma|^2)``."""
    square = np.sum(sigma * sigma, axis=-1, keepdims=True)
    found: Array = np.concatenate((1 - square, 2 * sigma), axis=-1) / (1 + square)
    return normalize(found)
