"""Euler angles of any sequence: their quaternion, and how they move with omega.

Stevens, Lewis, Johnson, Aircraft Control and Simulation (2016), 1.3, for yaw, pitch and roll.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import cos, sin

import numpy as np

from omegadot.reference_impl.arithmetic.components import Numbers, cross3, product4
from omegadot.reference_impl.rotations import conjugate, quaternion_product
from omegadot.reference_impl.system import Array

NO_TURN = np.array([1.0, 0.0, 0.0, 0.0])


@dataclass(frozen=True)
class Angles:
    """Which Euler angles. sequence: three intrinsic axes.  world, body: quaternions from the axes
    that they are relative to, to the scenario's; None where these are the same.
    """

    sequence: str = "ZYX"
    world: Array | None = None
    body: Array | None = None


def _turn(axis: int, angle: float) -> list[float]:
    found = [cos(0.5 * angle), 0.0, 0.0, 0.0]
    found[1 + axis] = sin(0.5 * angle)
    return found


def _axes(chart: Angles) -> list[int]:
    return ["XYZ".index(axis) for axis in chart.sequence]


def quaternion_of(e: Numbers, chart: Angles) -> list[float]:
    """world_R_body of the angles, a unit quaternion between the scenario's axes."""
    first, second, third = (_turn(k, a) for k, a in zip(_axes(chart), e, strict=True))
    own = product4(product4(first, second), third)
    if chart.world is not None:
        own = product4(chart.world.tolist(), own)
    return own if chart.body is None else product4(own, conjugate(chart.body).tolist())


def angle_rates(chart: Angles) -> Callable[[Numbers, Numbers], list[float]]:
    """``ė`` of the angles and ω in the scenario's body axes, rad/s.

    ``ω = ė₃ k + ė₂ R₃ᵀ j + ė₁ R₃ᵀ R₂ᵀ i``, solved for ė. ZeroDivisionError at the singularity.
    """
    from scipy.spatial.transform import Rotation

    i, j, k = _axes(chart)
    body = None if chart.body is None else Rotation.from_quat(np.roll(chart.body, -1))
    matrix = None if body is None else body.inv().as_matrix().tolist()
    last = [0.0, 0.0, 0.0]
    last[k] = 1.0

    def back(axis: int, angle: float, vector: Numbers) -> list[float]:
        """The transposed rotation about a coordinate axis."""
        m, n = (axis + 1) % 3, (axis + 2) % 3
        c, s = cos(angle), sin(angle)
        found = list(vector)
        found[m] = c * vector[m] + s * vector[n]
        found[n] = c * vector[n] - s * vector[m]
        return found

    def rates(e: Numbers, w: Numbers) -> list[float]:
        if matrix is not None:
            w = [sum(row[n] * w[n] for n in range(3)) for row in matrix]
        first, second = [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]
        first[i], second[j] = 1.0, 1.0
        second = back(k, e[2], second)
        first = back(k, e[2], back(j, e[1], first))
        normals = cross3(second, last), cross3(last, first), cross3(first, second)
        volume = sum(a * b for a, b in zip(first, normals[0], strict=True))
        return [sum(a * b for a, b in zip(w, n, strict=True)) / volume for n in normals]

    return rates


def angles_of(q: Array, chart: Angles) -> Array:
    """The angles (3,) rad of world_R_body, a unit quaternion (4,) between the scenario's axes."""
    from scipy.spatial.transform import Rotation

    world, body = (NO_TURN if turn is None else turn for turn in (chart.world, chart.body))
    own = quaternion_product(quaternion_product(conjugate(world), q), body)
    found: Array = Rotation.from_quat(np.roll(own, -1)).as_euler(chart.sequence)
    return found
