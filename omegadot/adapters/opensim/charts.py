"""The angles of OpenSim's joints, in two frames of the ground whose singularities are apart.

A free or ball joint keeps three angles ``R = Rx(a) Ry(b) Rz(c)`` of the body in the joint's frame
in the ground. They are singular at ``cos(b) = 0``: where the body's z-axis is along the frame's
x-axis. Of two frames, that of the world and one turned by 90 degrees about z, one is singular where
z is along the world's x, the other where it is along y, so that one is always far from it.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin

import numpy as np

from omegadot.reference_impl.rotations import normalize, quaternion_product, rotation_matrix
from omegadot.reference_impl.system import Array

# The world's frame is taken up to this component of the body's z-axis along the world's x. Then the
# singularity is 45 degrees away at least, else 44. It is no sine of an angle that bodies start at.
MOST = 0.7
ROOT = 0.5**0.5


@dataclass(frozen=True)
class Chart:
    """turned: whether the frame is turned. Vectors are (..., 3), quaternions (..., 4)."""

    turned: bool

    @property
    def frame_angles(self) -> tuple[float, float, float]:
        """rad: of the frame in the ground."""
        return (0.0, 0.0, 0.5 * np.pi if self.turned else 0.0)

    def in_world(self, vector: Array) -> Array:
        """Components in the world's axes of a vector in the frame's."""
        return _columns(vector, (1, 0, 2), (-1, 1, 1)) if self.turned else vector

    def in_frame(self, vector: Array) -> Array:
        """Components in the frame's axes of a vector in the world's."""
        return _columns(vector, (1, 0, 2), (1, -1, 1)) if self.turned else vector

    def angles_of(self, q: Array) -> Array:
        """a, b, c (3,) of a quaternion world-from-body (4,), exact to rounding at any b."""
        if self.turned:
            q = quaternion_product(np.array([ROOT, 0.0, 0.0, -ROOT]), q)
        r = rotation_matrix(normalize(q))
        a, b = np.arctan2(-r[1, 2], r[2, 2]), np.arctan2(r[0, 2], np.hypot(r[0, 0], r[0, 1]))
        last = np.cos(a) * r[1] + np.sin(a) * r[2]  # of Rx(-a) R = Ry(b) Rz(c)
        return np.array([a, b, np.arctan2(last[0], last[1])])

    def quaternions_of(self, angles: Array) -> Array:
        """Unit quaternions (n, 4), world-from-body, of angles (n, 3)."""
        c, s = np.cos(0.5 * angles), np.sin(0.5 * angles)
        first, second, third = np.zeros((3, len(angles), 4))
        for axis, turn in enumerate((first, second, third)):
            turn[:, 0], turn[:, 1 + axis] = c[:, axis], s[:, axis]
        q = quaternion_product(first, quaternion_product(second, third))
        if self.turned:
            q = quaternion_product(np.array([ROOT, 0.0, 0.0, ROOT]), q)
        return normalize(q)

    def is_apt(self, a: float, b: float) -> bool:
        """Whether these angles are far from its singularity: a rule of the attitude alone."""
        along = sin(a) * cos(b) if self.turned else sin(b)  # z along the world's x
        return (abs(along) > MOST) == self.turned


def _columns(vector: Array, order: tuple[int, ...], signs: tuple[int, ...]) -> Array:
    found: Array = vector[..., list(order)] * np.array(signs, float)
    return found


WORLD, TURNED = Chart(turned=False), Chart(turned=True)
