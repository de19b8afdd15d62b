"""Volume, mass and size of a part, and whether a set of parts is a body that can be turned.

A body's inertia is ``trace(S) 1 - S`` with its second moment S, the integral of ``rho r r^T`` about
the centre of mass: equation (5) with ``r_x^T r_x = |r|^2 1 - r r^T`` written out. Its smallest
principal moment is therefore the sum of the two smaller eigenvalues of S, and it is singular
exactly when all mass lies on one line. That is what is looked for here; the inertia itself is the
reference's business.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from omegadot.scenarios.errors import Phrase
from omegadot.scenarios.parts import Box, Capsule, Cylinder, Ellipsoid, Part, Point, Sphere
from omegadot.scenarios.quantities import LARGEST, SMALLEST, refuse
from omegadot.written import written

EPS = float(np.finfo(float).eps)


def _volume_and_squares(part: Part) -> tuple[float, tuple[float, float, float]]:
    match part:
        case Box():
            x, y, z = part.size
            return x * y * z, (x * x / 12, y * y / 12, z * z / 12)
        case Cylinder():
            r, h = part.radius, part.length
            return math.pi * r**2 * h, (r**2 / 4, r**2 / 4, h**2 / 12)
        case Sphere():
            across = part.radius**2 / 5
            return 4 / 3 * math.pi * part.radius**3, (across, across, across)
        case Ellipsoid():
            x, y, z = part.semi_axes
            return 4 / 3 * math.pi * (x * y * z), (x * x / 5, y * y / 5, z * z / 5)
        case Capsule():
            r, h = part.radius, part.length
            middle = h / (h + 4 / 3 * r)  # the cylinder's share of the mass
            caps = 1 - middle
            across = (middle / 4 + caps / 5) * r * r
            # the centre of a half ball lies 3/8 r beyond its flat face
            along = middle * h * h / 12 + caps * (h * h / 4 + 3 / 8 * h * r + r * r / 5)
            return math.pi * r**2 * (h + 4 / 3 * r), (across, across, along)
        case Point():
            return 0.0, (0.0, 0.0, 0.0)


def volume(part: Part) -> float:
    """The volume in m^3; zero for a point."""
    return _volume_and_squares(part)[0]


def mean_squares(part: Part) -> tuple[float, float, float]:
    """Mean x^2, y^2 and z^2 over the solid in m^2, part axes, about the part's centre."""
    return _volume_and_squares(part)[1]


def mass(part: Part) -> float:
    """The mass in kg, as given or density times volume."""
    if isinstance(part, Point) or part.density is None:
        assert part.mass is not None  # the part was validated: one of the two is given
        return part.mass
    return part.density * volume(part)


def rotation_of(quaternion: tuple[float, float, float, float]) -> NDArray[np.float64]:
    """The matrix (3, 3) of a unit quaternion (w, x, y, z)."""
    w, x, y, z = quaternion
    v = np.array([x, y, z])
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turned: NDArray[np.float64] = (w * w - v @ v) * np.eye(3) + 2 * np.outer(v, v) + 2 * w * skew
    return turned


def check_body_of_parts(parts: tuple[Part, ...]) -> None:
    """Refuse parts whose mass or inertia no engine could hold.

    Raises the error of `refuse` when a mass or the inertia leaves the range of magnitudes, or when
    all mass lies, to rounding, on one line.
    """
    masses = np.array([mass(part) for part in parts])
    for index, (part, amount) in enumerate(zip(parts, masses, strict=True)):
        if not SMALLEST <= amount <= LARGEST:
            raise refuse(
                f"choose sizes for a mass of {written(SMALLEST)} to {written(LARGEST)} kg",
                key=f"part[{index}].density",
                found=getattr(part, "density", None),
            )
    places = np.array([part.position for part in parts])
    offsets = places - masses @ places / masses.sum()
    second_moment = np.einsum("n,ni,nj->ij", masses, offsets, offsets)
    for part, amount in zip(parts, masses, strict=True):
        axes = rotation_of(part.orientation)
        second_moment += amount * (axes * mean_squares(part)) @ axes.T
    small, middle, large = np.linalg.eigvalsh(second_moment)
    # eigvalsh is good to a few ulps of the largest eigenvalue, an offset to a few of the farthest
    # place: what lies below that is a line
    rounding = 16 * EPS * large + masses.sum() * (4 * EPS * np.abs(places).max()) ** 2
    if small + middle <= rounding:
        raise refuse(
            "move a part off the line, or give it a thickness, so that the body has an inertia"
            " about every axis",
            key="part",
            found=Phrase("a set of parts on one line"),
        )
    if small + middle < SMALLEST or middle + large > LARGEST:
        raise refuse(
            f"choose parts for an inertia of {written(SMALLEST)} to {written(LARGEST)} kg m^2",
            key="part",
            found=Phrase(
                f"a body with moments from {written(small + middle, 3)} to "
                f"{written(middle + large, 3)}"
            ),
        )
