"""What a scenario's body looks like: its parts, or a homogeneous solid of the same inertia."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from pydantic import TypeAdapter, ValidationError

from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.system import Array, System
from omegadot.reports.page.view_3d.meshes import Mesh, box, cylinder, ellipsoid, mesh_of
from omegadot.scenarios.parts import Part
from omegadot.scenarios.solids import mass

_MOST_PARTS = 24
# A solid of the body's inertia is drawn at least this thick, over its length: a needle is thinner.
_THINNEST = 0.02
# Moments this close, relative to the largest, are drawn as equal.
_ALIKE = 1e-5
_PARTS = TypeAdapter(tuple[Part, ...])


@dataclass(frozen=True)
class Look:
    """How a body is drawn. solids: body axes, m, from the picture's middle, which is the
    pivot of a pivoted body and else the centre of mass.

    told: in words, what is drawn.  tip: (3,) m, the point whose trace is shown.
    inertia: (3, 3), what angular motion meets; ball: (3, 3), a semi-axis of its ellipsoid a column.
    """

    solids: tuple[Mesh, ...]
    reported: str
    tip: Array
    inertia: Array
    ball: Array


def look_of(system: System, definition: Mapping[str, Any], spin: Array) -> Look:
    """The body of a scenario. spin: (3,) its first angular velocity, body axes, for the tip."""
    inertia = moving_inertia(system)
    parts = _parts(definition)
    if parts and len(parts) <= _MOST_PARTS:
        solids, reported = _of_parts(parts, system), "drawn from its parts"
    else:
        solids, reported = _of_inertia(system)
    return Look(solids, reported, _tip(solids, inertia, spin), inertia, _ball(inertia))


def _parts(definition: Mapping[str, Any]) -> tuple[Part, ...]:
    try:
        return _PARTS.validate_python(definition["body"]["part"])
    except (KeyError, TypeError, ValidationError):
        return ()


def _of_parts(parts: tuple[Part, ...], system: System) -> tuple[Mesh, ...]:
    sides = 24 if len(parts) <= 3 else 12 if len(parts) <= 8 else 8
    places = np.array([part.position for part in parts])
    reach = float(np.max(np.abs(places - system.body.center_of_mass))) or 1.0
    heaviest = max(mass(part) for part in parts)
    centre = lever(system) - system.body.center_of_mass
    meshes = []
    for part in parts:
        # Points have no size: balls whose volumes go with their masses.
        radius = 0.12 * reach * (mass(part) / heaviest) ** (1 / 3)
        still = np.array([1.0, 0.0, 0.0, 0.0])
        meshes.append(mesh_of(part, sides, radius).placed(centre, still))
    return tuple(meshes)


def _of_inertia(system: System) -> tuple[tuple[Mesh, ...], str]:
    """The homogeneous solid: a ball, cylinder or box, as one, two or three moments differ.

    With principal moments I_k the mean squares over the solid are ``tr(I)/2 - I_k``, over m.
    """
    moments, axes = np.linalg.eigh(system.body.inertia)
    squares = np.maximum(0.5 * moments.sum() - moments, 0.0) / float(system.body.mass)
    solid, name = _solid(squares)
    if np.linalg.det(axes) < 0:
        axes = axes * [-1.0, 1.0, 1.0]
    centre = lever(system)
    turned = Mesh(solid.vertices @ axes.T, solid.faces, solid.marked)
    reported = f"drawn as the homogeneous {name} of its mass and inertia"
    reach = float(np.max(-turned.vertices @ centre))
    distance = float(np.sqrt(centre @ centre))
    if distance == 0.0:
        return (turned,), reported
    # The pivot stays in sight: the solid is drawn small enough to end before it, on a rod.
    scale = min(1.0, 0.6 * distance**2 / reach)
    reported += f", at {scale:.2g} of its size," * (scale < 1.0) + " on a rod from the pivot"
    length = distance - scale * reach / distance
    rod = _rod(centre / distance, length, 0.05 * distance)
    shrunk = Mesh(centre + scale * turned.vertices, turned.faces, turned.marked)
    return (shrunk, rod), reported


def _solid(squares: Array) -> tuple[Mesh, str]:
    """In principal axes, smallest moment first, so that the squares descend."""
    largest = float(squares[0])
    thick = np.maximum(squares, largest * _THINNEST**2)
    if squares[0] - squares[2] <= _ALIKE * largest:
        return ellipsoid(np.sqrt(5 * thick), 24), "ball"
    # The cylinder's axis is z: the axis of the moment that stands alone.
    for alone, across in ((0, 2), (2, 0)):
        if abs(squares[across] - squares[1]) <= _ALIKE * largest:
            radius, length = 2 * np.sqrt(thick[across]), np.sqrt(12 * thick[alone])
            mesh = cylinder(float(radius), float(length), 24)
            order = [2, 0, 1] if alone == 0 else [0, 1, 2]
            return Mesh(mesh.vertices[:, order], mesh.faces, mesh.marked), "cylinder"
    return box(np.sqrt(12 * thick)), "box"


def _rod(axis: Array, length: float, radius: float) -> Mesh:
    """From the origin along the unit axis."""
    aside = np.eye(3)[np.argmin(np.abs(axis))]
    first = np.cross(axis, aside)
    first /= np.sqrt(first @ first)
    mesh = cylinder(radius, length, 12)
    turned = mesh.vertices @ np.array([first, np.cross(axis, first), axis])
    return Mesh(turned + 0.5 * length * axis, mesh.faces, (False,) * len(mesh.faces))


def _tip(solids: tuple[Mesh, ...], inertia: Array, spin: Array) -> Array:
    """Where the principal axis nearest to the spin leaves the body, on the spin's side."""
    _, axes = np.linalg.eigh(inertia)
    along = spin @ axes
    nearest = int(np.argmax(np.abs(along)))
    axis = axes[:, nearest] * (1.0 if along[nearest] >= 0 else -1.0)
    return np.asarray(axis * max(float(np.max(mesh.vertices @ axis)) for mesh in solids))


def _ball(inertia: Array) -> Array:
    """Poinsot's ellipsoid ``r . I r = 1``, drawn so that its greatest semi-axis is 1."""
    moments, axes = np.linalg.eigh(inertia)
    return np.asarray(axes * np.sqrt(moments[0] / moments))
