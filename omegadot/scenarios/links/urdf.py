"""A link of a URDF: wiki.ros.org/urdf/XML/link.

The link's frame is the body's: `origin` places the inertial frame in it, `rpy` about fixed axes.
"""

from __future__ import annotations

from typing import Any
from xml.etree.ElementTree import Element

import numpy as np

from omegadot.scenarios.links.place import Place
from omegadot.scenarios.links.turns import Matrix, roll_pitch_yaw, symmetric, turned_tensor

MOMENTS = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


def links(root: Element) -> dict[str, list[Element]]:
    """The links by name."""
    found: dict[str, list[Element]] = {}
    for link in root.findall("link"):
        found.setdefault(link.get("name") or "", []).append(link)
    return found


def body(link: Element, place: Place) -> dict[str, Any]:
    """The link's mass, centre of mass and inertia as a scenario's body. Raises ScenarioError."""
    inertial = place.only(link, "inertial")
    if inertial is None:
        place.refuse("without <inertial>, so it has no mass", "give it one or choose another link")
    own = place.inner("inertial")
    mass, inertia = own.only(inertial, "mass"), own.only(inertial, "inertia")
    if mass is None or inertia is None:
        lacking = "mass" if mass is None else "inertia"
        own.inner(lacking).refuse("missing", f"give <{lacking}>")
    center, rotation = _origin(own.only(inertial, "origin"), own.inner("origin"))
    tensor = symmetric(*(own.inner("inertia").attribute(inertia, name) for name in MOMENTS))
    return {
        "mass": own.inner("mass").attribute(mass, "value"),
        "center_of_mass": center,
        "inertia": turned_tensor(rotation, tensor),
    }


def _origin(origin: Element | None, place: Place) -> tuple[list[float], Matrix]:
    if origin is None:
        return [0.0, 0.0, 0.0], np.eye(3)
    center = place.inner("xyz").numbers(origin.get("xyz", "0 0 0"), 3, "three numbers")
    angles = place.inner("rpy").numbers(origin.get("rpy", "0 0 0"), 3, "three angles in rad")
    return center, roll_pitch_yaw(*angles)
