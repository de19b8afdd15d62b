"""The solids of a body as convex polyhedra, good enough to look at."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.system import Array
from omegadot.scenarios.parts import Box, Capsule, Cylinder, Ellipsoid, Part, Point, Sphere

# A round solid of revolution carries a stripe this wide, so that its own spin is to be seen.
_STRIPE = np.pi / 6
_BOX_FACES = (
    ((0, 1, 3, 2), False), ((4, 6, 7, 5), True),  # -x, +x
    ((0, 4, 5, 1), False), ((2, 3, 7, 6), True),  # -y, +y
    ((0, 2, 6, 4), False), ((1, 5, 7, 3), True),  # -z, +z
)  # fmt: skip


@dataclass(frozen=True)
class Mesh:
    """A convex polyhedron.

    vertices: (n, 3) m. faces: vertex numbers, counter-clockwise seen from outside. marked: the
    faces that are painted apart, by which an attitude is told from the one turned half around.
    """

    vertices: Array
    faces: tuple[tuple[int, ...], ...]
    marked: tuple[bool, ...]

    def placed(self, position: Array, orientation: Array, scale: float = 1.0) -> Mesh:
        """The solid scaled, turned by the quaternion and then moved."""
        turned = rotate(orientation, self.vertices * scale)
        return Mesh(position + turned, self.faces, self.marked)


def box(size: Array) -> Mesh:
    """A cuboid of full edge lengths `size`; its faces towards +x, +y and +z are marked."""
    corners = np.stack(np.meshgrid(*[[-0.5, 0.5]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    faces, marked = zip(*_BOX_FACES, strict=True)
    return Mesh(corners * size, faces, marked)


def revolved(profile: Array, sides: int, lead: float = 0.5) -> Mesh:
    """The convex solid with the profile (n, 2) of radius and z, from the lowest z up, about z.

    Where an end has a radius it is closed by two flat halves, one marked, else it comes to a
    point. The first corner lies `lead` sides before +x.
    """
    turn = 2 * np.pi * (np.arange(sides) - lead) / sides
    rings, vertices, count = [], [], 0
    for radius, z in profile:
        angles = turn if radius > 0 else turn[:1]
        around = [radius * np.cos(angles), radius * np.sin(angles), np.full(len(angles), z)]
        vertices.append(np.stack(around, axis=-1))
        rings.append([count + k % len(angles) for k in range(sides)])
        count += len(angles)
    faces: list[tuple[int, ...]] = []
    marked: list[bool] = []
    for low, high in pairwise(rings):
        for k in range(sides):
            after = (k + 1) % sides
            # Around a point two of the four fall together.
            faces.append(tuple(dict.fromkeys((low[k], low[after], high[after], high[k]))))
            across = (2 * np.pi * k / sides + np.pi) % (2 * np.pi) - np.pi
            marked.append(abs(across) < _STRIPE)
    for ring in (rings[0][::-1], rings[-1]):
        if len(set(ring)) > 1:
            half = sides // 2
            faces += [tuple(ring[: half + 1]), (*ring[half:], ring[0])]
            marked += [True, False]
    return Mesh(np.concatenate(vertices), tuple(faces), tuple(marked))


def cylinder(radius: float, length: float, sides: int) -> Mesh:
    """A circular cylinder along z, a prism of so many sides inside it; striped along +x."""
    return revolved(np.array([[radius, -0.5 * length], [radius, 0.5 * length]]), sides)


def capsule(radius: float, length: float, sides: int) -> Mesh:
    """A cylinder along z between two half balls; a stripe along +x."""
    up = np.linspace(0.0, 0.5 * np.pi, max(3, sides // 4 + 1))
    cap = radius * np.stack([np.cos(up), np.sin(up)], axis=-1)
    cap[-1, 0] = 0.0
    top = cap + np.array([0.0, 0.5 * length])
    return revolved(np.concatenate([top[::-1] * [1.0, -1.0], top]), sides)


def ellipsoid(semi_axes: Array, sides: int) -> Mesh:
    """A ball drawn out along its axes; four of its eight octants are marked."""
    up = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 2 * (sides // 4) + 1)
    profile = np.stack([np.cos(up), np.sin(up)], axis=-1)
    profile[[0, -1], 0] = 0.0
    ball = revolved(profile, 4 * (sides // 4), lead=0.0)  # octants end where faces do
    middles = [np.prod(ball.vertices[list(face)].mean(axis=0)) for face in ball.faces]
    return Mesh(ball.vertices * semi_axes, ball.faces, tuple(bool(m > 0) for m in middles))


def mesh_of(part: Part, sides: int, point_radius: float) -> Mesh:
    """A part where it stands in body axes; a point is drawn as a ball of `point_radius`, m."""
    match part:
        case Box():
            mesh = box(np.array(part.size))
        case Cylinder():
            mesh = cylinder(part.radius, part.length, sides)
        case Capsule():
            mesh = capsule(part.radius, part.length, sides)
        case Sphere():
            mesh = ellipsoid(np.full(3, part.radius), sides)
        case Ellipsoid():
            mesh = ellipsoid(np.array(part.semi_axes), sides)
        case Point():
            mesh = ellipsoid(np.full(3, point_radius), sides)
    return mesh.placed(np.array(part.position), np.array(part.orientation))
