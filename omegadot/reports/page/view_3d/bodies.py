"""How a scenario's body is drawn: its parts, or a homogeneous solid of the same inertia."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from pydantic import TypeAdapter, ValidationError

from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.schemes.short_turns_euler import quaternion_read
from omegadot.reference_impl.system import Array, System
from omegadot.reports.charts.packing import rounded
from omegadot.reports.page.view_3d.solids import Solid, solid_of
from omegadot.scenarios.parts import Part
from omegadot.scenarios.solids import mass
from omegadot.written import written

_MOST_PARTS = 200
# A solid of the body's inertia is drawn at least this thick, over its length: a needle is thinner.
_THINNEST = 0.02
# Moments this close, relative to the largest, are drawn as equal.
_ALIKE = 1e-5
_PARTS = TypeAdapter(tuple[Part, ...])


@dataclass(frozen=True)
class Look:
    """How a body is drawn. solids: body axes, m, from the picture's middle, which is the
    pivot of a pivoted body and else the centre of mass.

    description: what is drawn.  tip: (3,) m, the point whose trace is shown.
    inertia: (3, 3), what angular motion meets; ellipsoid: (3, 3), a semi-axis of the inertia
    ellipsoid a column.
    """

    solids: tuple[Solid, ...]
    description: str
    tip: Array
    inertia: Array
    ellipsoid: Array

    def payload(self) -> dict[str, Any]:
        """All of it as plain numbers, lengths over the body's rough size: for single precision."""
        size = max(float(np.abs([*one.size, *one.position]).max()) for one in self.solids)
        body = [
            [one.shape, *map(_short, (one.size / size, one.position / size, one.orientation))]
            for one in self.solids
        ]
        return {
            "description": self.description,
            "tip": _short(self.tip / size),
            "inertia": _short(self.inertia),
            "body": body,
            "ellipsoid": _short(self.ellipsoid),
        }


def look_of(system: System, definition: Mapping[str, Any], spin: Array) -> Look:
    """The body of a scenario. spin: (3,) its first angular velocity, body axes, for the tip."""
    inertia = moving_inertia(system)
    parts = _parts(definition)
    if parts and len(parts) <= _MOST_PARTS:
        solids, description = _of_parts(parts, system), "drawn from its parts"
    else:
        solids, description = _of_inertia(system)
    return Look(solids, description, _tip(solids, inertia, spin), inertia, _ellipsoid(inertia))


def _parts(definition: Mapping[str, Any]) -> tuple[Part, ...]:
    try:
        return _PARTS.validate_python(definition["body"]["part"])
    except (KeyError, TypeError, ValidationError):
        return ()


def _of_parts(parts: tuple[Part, ...], system: System) -> tuple[Solid, ...]:
    places = np.array([part.position for part in parts])
    reach = float(np.max(np.abs(places - system.body.center_of_mass))) or 1.0
    heaviest = max(mass(part) for part in parts)
    middle = system.body.center_of_mass - lever(system)
    # Points have no size: balls whose volumes go with their masses.
    return tuple(
        solid_of(part, middle, 0.12 * reach * (mass(part) / heaviest) ** (1 / 3)) for part in parts
    )


def _of_inertia(system: System) -> tuple[tuple[Solid, ...], str]:
    """The homogeneous solid: a ball, cylinder or box, as one, two or three moments differ.

    With principal moments I_k the mean squares over the solid are ``tr(I)/2 - I_k``, over m.
    """
    moments, axes = np.linalg.eigh(system.body.inertia)
    squares = np.maximum(0.5 * moments.sum() - moments, 0.0) / float(system.body.mass)
    name, shape, size, order = _solid(squares)
    axes = axes[:, order]
    if np.linalg.det(axes) < 0:
        axes = axes * [-1.0, 1.0, 1.0]
    turned = quaternion_read(axes)
    centre = lever(system)
    solid = Solid(shape, size, centre, turned)
    description = f"drawn as the homogeneous {name} of its mass and inertia"
    distance = float(np.sqrt(centre @ centre))
    if distance == 0.0:
        return (solid,), description
    # The pivot stays in sight: the solid is drawn small enough to end before it, on a rod.
    axis = centre / distance
    towards = solid.height(-axis) + distance
    scale = min(1.0, 0.6 * distance / towards)
    description += (
        f", {written(scale, 2)} times as large, so that the pivot stays in sight," * (scale < 1.0)
        + " on a rod from the pivot"
    )
    shrunk = Solid(shape, scale * size, centre, turned)
    return (shrunk, _rod(axis, distance - scale * towards, 0.05 * distance)), description


def _solid(squares: Array) -> tuple[str, str, Array, list[int]]:
    """Name, shape, size, and which principal axes are the solid's x, y and z.

    squares: in principal axes, smallest moment first, so that they descend.
    """
    largest = float(squares[0])
    thick = np.maximum(squares, largest * _THINNEST**2)
    if squares[0] - squares[2] <= _ALIKE * largest:
        return "ball", "ellipsoid", np.sqrt(5 * thick), [0, 1, 2]
    # The cylinder's axis is z: the axis of the moment that stands alone.
    for alone, across in ((0, 2), (2, 0)):
        if abs(squares[across] - squares[1]) <= _ALIKE * largest:
            size = np.array([2 * np.sqrt(thick[across]), np.sqrt(12 * thick[alone])])
            return "cylinder", "cylinder", size, [1, 2, 0] if alone == 0 else [0, 1, 2]
    return "box", "box", np.sqrt(12 * thick), [0, 1, 2]


def _rod(axis: Array, length: float, radius: float) -> Solid:
    """From the origin along the unit axis: z turned to it by the quaternion (1 + z·a, z x a)."""
    x, y, z = axis
    # 1 + z without cancellation near the opposite axis.
    turned = np.array([1 + z if z > 0 else (x * x + y * y) / (1 - z), -y, x, 0.0])
    turned = turned if turned.any() else np.array([0.0, 1.0, 0.0, 0.0])
    turned /= np.sqrt(turned @ turned)
    return Solid("cylinder", np.array([radius, length]), 0.5 * length * axis, turned)


def _tip(solids: tuple[Solid, ...], inertia: Array, spin: Array) -> Array:
    """Where the principal axis nearest to the spin leaves the body, on the spin's side."""
    _, axes = np.linalg.eigh(inertia)
    along = spin @ axes
    nearest = int(np.argmax(np.abs(along)))
    axis = axes[:, nearest] * (1.0 if along[nearest] >= 0 else -1.0)
    return np.asarray(axis * max(solid.height(axis) for solid in solids))


def _ellipsoid(inertia: Array) -> Array:
    """Poinsot's ellipsoid ``r . I r = 1``, drawn so that its greatest semi-axis is 1."""
    moments, axes = np.linalg.eigh(inertia)
    return np.asarray(axes * np.sqrt(moments[0] / moments))


def _short(values: Array) -> list[float | None]:
    return [rounded(x, 6) for x in np.ravel(values).tolist()]
