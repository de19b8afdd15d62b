"""The four shapes that the page draws."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from omegadot.reference_impl.rotations import rotate_inverse
from omegadot.reference_impl.system import Array
from omegadot.scenarios.parts import Box, Capsule, Cylinder, Ellipsoid, Part, Point, Sphere


@dataclass(frozen=True)
class Solid:
    """A solid in body axes. position: (3,) m, its centre; orientation: its axes to the body's.

    ========= ========================================================
    shape     size, m
    ========= ========================================================
    box       (3,) the full edge lengths
    cylinder  (2,) radius and length, the axis along z
    capsule   (2,) radius and length between the caps, the axis along z
    ellipsoid (3,) the semi-axes
    ========= ========================================================
    """

    shape: str
    size: Array
    position: Array
    orientation: Array

    def height(self, direction: Array) -> float:
        """How far it reaches from the origin along the unit direction, m: its support."""
        x, y, z = np.abs(rotate_inverse(self.orientation, direction))
        match self.shape:
            case "box":
                own = 0.5 * float(self.size @ [x, y, z])
            case "ellipsoid":
                own = math.hypot(*(self.size * [x, y, z]))
            case "cylinder":
                own = float(self.size @ [math.hypot(x, y), 0.5 * z])
            case _:
                own = float(self.size @ [1.0, 0.5 * z])
        return own + float(self.position @ direction)


def solid_of(part: Part, middle: Array, point_radius: float) -> Solid:
    """A part, seen from the picture's `middle`; a point is drawn as a ball of `point_radius`, m."""
    size: tuple[float, ...]
    match part:
        case Box():
            shape, size = "box", part.size
        case Cylinder():
            shape, size = "cylinder", (part.radius, part.length)
        case Capsule():
            shape, size = "capsule", (part.radius, part.length)
        case Sphere():
            shape, size = "ellipsoid", (part.radius,) * 3
        case Ellipsoid():
            shape, size = "ellipsoid", part.semi_axes
        case Point():
            shape, size = "ellipsoid", (point_radius,) * 3
    return Solid(
        shape, np.array(size), np.array(part.position) - middle, np.array(part.orientation)
    )
