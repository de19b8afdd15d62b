"""A link of an SDF: sdformat.org/spec, element link.

The link's frame is the body's: `pose` places the inertial frame in it. SDF takes 1 kg and a unit
inertia for what is left out; here that is refused, as it is hardly ever meant.

With ``<inertial auto="true">`` the body follows from the link's plain shapes. A collision's density
is its own, else the inertial's, else 1000 kg/m^3; a mass in the inertial scales the sum. The
inertial's own pose and inertia are overwritten (sdformat 15, Link and Collision). Meshes, planes
and the like are refused.
"""

from __future__ import annotations

import math
from functools import partial
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np

from omegadot.scenarios.links.link import Link
from omegadot.scenarios.links.place import Place, numbers_in
from omegadot.scenarios.links.poses import MOMENTS, flag, pose_of, turned_tensor
from omegadot.scenarios.parts import SHAPES
from omegadot.scenarios.solids import mean_squares, volume

DENSITY = 1000.0  # kg/m^3, sdformat's where none is given
SIZES = {  # sdformat's name of each size, how many numbers it is, and a part's name of it
    "box": {"size": (3, "size")},
    "sphere": {"radius": (1, "radius")},
    "ellipsoid": {"radii": (3, "semi_axes")},
    "cylinder": {"radius": (1, "radius"), "length": (1, "length")},
    "capsule": {"radius": (1, "radius"), "length": (1, "length")},
    "cone": {"radius": (1, "radius"), "length": (1, "length")},
}


def links(root: Element) -> list[Link]:
    """The links of a file, ``model::link`` by name, and ``outer::inner::link`` in nested models."""
    found: list[Link] = []
    pending = [(root, "")]
    for element, scope in pending:
        for child in element:
            name = scope + (child.get("name") or "")
            if child.tag == "link":
                found.append(Link(name, _has_mass(child), partial(_body, child)))
            elif child.tag == "model":
                pending.append((child, f"{name}::"))
            elif child.tag == "world":
                pending.append((child, scope))
    return found


def _has_mass(link: Element) -> bool:
    inertial = link.find("inertial")
    return inertial is not None and numbers_in(inertial.findtext("mass") or "") != [0.0]


def _body(link: Element, place: Place) -> dict[str, Any]:
    """The link's mass, centre of mass and inertia as a scenario's body. Raises ScenarioError."""
    inertial = place.only(link, "inertial")
    if inertial is None:
        place.refuse("without <inertial>", "give it one or choose another link")
    own = place.inner("inertial")
    if own.only(inertial, "fluid_added_mass") is not None:
        own.inner("fluid_added_mass").refuse("given", "take it out, there is no fluid here")
    if flag(inertial.get("auto"), own.inner("auto")):
        return _body_of_shapes(link, inertial, place)
    inertia = own.only(inertial, "inertia")
    if inertia is None:
        own.inner("inertia").refuse("missing", "give it")
    center, rotation = pose_of(own.only(inertial, "pose"), own.inner("pose"))
    moments = (_moment(inertia, name, own.inner("inertia")) for name in MOMENTS)
    return {
        "mass": own.inner("mass").number(own.text(inertial, "mass"), "a mass in kg"),
        "center_of_mass": center,
        "inertia": turned_tensor(rotation, moments),
    }


def _moment(inertia: Element, name: str, place: Place) -> float:
    text = place.text(inertia, name)
    if text is None and name in ("ixy", "ixz", "iyz"):
        return 0.0
    return place.inner(name).number(text, "a number in kg m^2")


def _body_of_shapes(link: Element, inertial: Element, place: Place) -> dict[str, Any]:
    """Mass, centre of mass and inertia of all collisions together. Raises ScenarioError.

    With masses m, centres c and second moments S about them, the inertia about the common centre
    is ``trace(T) 1 - T``, T the sum of ``S + m c c^T`` less ``M C C^T``.
    """
    own = place.inner("inertial")
    collisions = link.findall("collision")
    if not collisions:
        own.refuse('auto="true" without a <collision>', "give one or write the inertia out")
    if len({collision.get("name") for collision in collisions}) < len(collisions):
        place.refuse("a link with two collisions of one name", "give every one its own")
    solids = [_solid(one, _density(inertial, own, DENSITY), place) for one in collisions]
    masses = np.array([mass for mass, _, _ in solids])
    centers = np.array([center for _, center, _ in solids])
    center = masses @ centers / masses.sum()
    offsets = centers - center
    total = sum(second for _, _, second in solids)
    total = total + np.einsum("n,ni,nj->ij", masses, offsets, offsets)
    scale = 1.0
    if (given := own.text(inertial, "mass")) is not None:
        (mass,) = own.inner("mass").positive(given, 1, "a mass in kg")
        scale = mass / masses.sum()
    return {
        "mass": float(scale * masses.sum()),
        "center_of_mass": center.tolist(),
        "inertia": (scale * (np.trace(total) * np.eye(3) - total)).tolist(),
    }


def _density(element: Element, place: Place, otherwise: float) -> float:
    text = place.text(element, "density")
    return otherwise if text is None else place.inner("density").positive(text, 1, "kg/m^3")[0]


def _solid(collision: Element, density: float, link: Place) -> tuple[float, Any, Any]:
    """Mass, centre of mass and second moment about it, in the link's axes."""
    place = link.inner(f"collision {collision.get('name')!r}")
    density = _density(collision, place, density)
    center, rotation = pose_of(place.only(collision, "pose"), place.inner("pose"))
    geometry = place.only(collision, "geometry")
    shapes = [] if geometry is None else list(geometry)
    if len(shapes) != 1 or shapes[0].tag not in SIZES:
        found = " and ".join(f"<{shape.tag}>" for shape in shapes) or "without a shape"
        place.refuse(f"{found}, under auto inertia", f"give one of {', '.join(SIZES)}")
    (shape,) = shapes
    own = place.inner(shape.tag)
    sizes = {
        name: own.inner(key).positive(own.text(shape, key), count, "sizes in m")
        for key, (count, name) in SIZES[shape.tag].items()
    }
    amount, squares, shift = _homogeneous(shape.tag, sizes)
    mass = density * amount
    axes = np.asarray(rotation)
    second = mass * (axes * squares) @ axes.T
    return mass, np.array(center) + axes[:, 2] * shift, second


def _homogeneous(shape: str, sizes: dict[str, list[float]]) -> tuple[float, Any, float]:
    """Volume, mean squares about the centre of mass, and where on z that is."""
    if shape == "cone":  # its base at -length/2: the centre of mass is a quarter up from there
        (radius,), (length,) = sizes["radius"], sizes["length"]
        across = 3.0 / 20.0 * radius**2
        squares = np.array([across, across, 3.0 / 80.0 * length**2])
        return math.pi / 3.0 * radius**2 * length, squares, -0.25 * length
    given = {name: value if len(value) == 3 else value[0] for name, value in sizes.items()}
    part: Any = SHAPES[shape].model_validate({"shape": shape, "mass": 1.0, **given})
    return volume(part), np.array(mean_squares(part)), 0.0
