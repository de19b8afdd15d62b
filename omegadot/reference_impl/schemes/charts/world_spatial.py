"""A quaternion and the spatial velocity in the world's axes, about the place where a step starts.

It is ω in the world's axes and the velocity u of the body's point at one place of the world: the
inertial representation of Featherstone, Rigid Body Dynamics Algorithms (2008), 2.2. Where that
place is makes no difference to a step, as one such u is another and ``W × d``, of a constant d.
"""

from __future__ import annotations

from omegadot.reference_impl.arithmetic.components import Number, Numbers
from omegadot.reference_impl.schemes.charts.chart import Chart
from omegadot.reference_impl.schemes.charts.world_quaternion import rate, unit


def _unit_rate(q: Numbers, spin: Numbers) -> list[Number]:
    return rate(unit(q), spin)


WORLD_SPATIAL = Chart(4, unit, unit, _unit_rate, from_start=True)
