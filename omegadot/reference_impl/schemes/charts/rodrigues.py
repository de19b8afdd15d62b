"""Modified Rodrigues parameters ``σ = tan(angle/4) axis`` of the shorter turn, and ω in body axes.

Schaub, Junkins, Analytical Mechanics of Space Systems (2018), 3.5. After a step a σ longer than 1
is exchanged for its shadow ``-σ / |σ|²``, the same attitude by the shorter turn.
"""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.arithmetic.components import Number, Numbers, cross3
from omegadot.reference_impl.schemes.charts.chart import Chart


def _of_quaternion(q: Numbers) -> list[Number]:
    """``σ = q⃗ / (1 + w)`` of that of ±q with w at least zero."""
    w, x, y, z = q
    sign = (-1.0 if w < 0 else 1.0) if type(w) is float else np.where(w < 0, -1.0, 1.0)
    below = sign * (1 + sign * w)
    return [x / below, y / below, z / below]


def _quaternion(s: Numbers) -> list[Number]:
    """``(1 - |σ|², 2 σ) / (1 + |σ|²)``."""
    x, y, z = s
    square = x * x + y * y + z * z
    below = 1 + square
    return [(1 - square) / below, 2 * x / below, 2 * y / below, 2 * z / below]


def _rate(s: Numbers, w: Numbers) -> list[Number]:
    """``σ̇ = ¼ ((1 - |σ|²) ω + 2 σ × ω + 2 (σ·ω) σ)``."""
    x, y, z = s
    own, along = 1 - (x * x + y * y + z * z), 2 * (x * w[0] + y * w[1] + z * w[2])
    across = cross3(s, w)
    return [
        0.25 * (own * a + 2 * b + along * c) for a, b, c in zip(w, across, (x, y, z), strict=True)
    ]


RODRIGUES = Chart(3, _of_quaternion, _quaternion, _rate, in_world=False)
