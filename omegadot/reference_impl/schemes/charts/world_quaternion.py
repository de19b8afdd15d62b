"""A quaternion, and ω in the world's axes: ``Q̇ = ½ (0, W) Q``, ``W = R ω``."""

from __future__ import annotations

from omegadot.reference_impl.arithmetic.components import Number, Numbers, length
from omegadot.reference_impl.schemes.charts.chart import Chart


def unit(q: Numbers) -> list[Number]:
    """The quaternion of the same direction."""
    w, x, y, z = q
    size = length(w * w + x * x + y * y + z * z)
    return [w / size, x / size, y / size, z / size]


def rate(q: Numbers, spin: Numbers) -> list[Number]:
    """``½ (0, W) Q``, linear in Q, which need not be unit: its length makes no difference."""
    w, x, y, z = q
    a, b, c = 0.5 * spin[0], 0.5 * spin[1], 0.5 * spin[2]
    return [
        -a * x - b * y - c * z,
        a * w + b * z - c * y,
        b * w + c * x - a * z,
        c * w + a * y - b * x,
    ]


def _same(q: Numbers) -> Numbers:
    return q


WORLD_QUATERNION = Chart(4, _same, unit, rate)
