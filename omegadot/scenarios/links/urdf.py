"""A link of a URDF: wiki.ros.org/urdf/XML/link.

The link's frame is the body's: `origin` places the inertial frame in it, `rpy` about fixed axes or,
from version 1.1 on, `quat_xyzw`.
"""

from __future__ import annotations

from functools import partial
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np

from omegadot.scenarios.links.link import Link
from omegadot.scenarios.links.place import Place, numbers_in
from omegadot.scenarios.links.poses import (
    MOMENTS,
    Matrix,
    of_quaternion,
    roll_pitch_yaw,
    turned_tensor,
)

WITH_QUATERNIONS = ("1.1", "1.2")  # versions; others ignore the attribute


def links(root: Element) -> list[Link]:
    """The links of a file."""
    version = root.get("version", "1.0")
    return [
        Link(link.get("name") or "", _has_mass(link), partial(_body, link, version))
        for link in root.findall("link")
    ]


def _has_mass(link: Element) -> bool:
    mass = link.find("inertial/mass")
    return mass is not None and numbers_in(mass.get("value", "0")) != [0.0]


def _body(link: Element, version: str, place: Place) -> dict[str, Any]:
    """The link's mass, centre of mass and inertia as a scenario's body. Raises ScenarioError."""
    inertial = place.only(link, "inertial")
    inside = [] if inertial is None else list(inertial.iter())
    macros = any(element.tag.startswith("xacro:") for element in (*link, *inside))
    if macros or any("$" in value for element in inside for value in element.attrib.values()):
        place.refuse("a link with macros of xacro", "expand it with xacro first")
    if inertial is None:
        place.refuse("without <inertial>, so it has no mass", "give it one or choose another link")
    own = place.inner("inertial")
    mass, inertia = own.only(inertial, "mass"), own.only(inertial, "inertia")
    if mass is None or inertia is None:
        lacking = "mass" if mass is None else "inertia"
        own.inner(lacking).refuse("missing", f"give <{lacking}>")
    center, rotation = _origin(own.only(inertial, "origin"), version, own.inner("origin"))
    moments = (own.inner("inertia").attribute(inertia, name) for name in MOMENTS)
    return {
        "mass": own.inner("mass").attribute(mass, "value"),
        "center_of_mass": center,
        "inertia": turned_tensor(rotation, moments),
    }


def _origin(origin: Element | None, version: str, place: Place) -> tuple[list[float], Matrix]:
    if origin is None:
        return [0.0, 0.0, 0.0], np.eye(3)
    center = place.inner("xyz").numbers(origin.get("xyz", "0 0 0"), 3, "three numbers")
    quaternion = origin.get("quat_xyzw")
    if quaternion is None:
        own = place.inner("rpy")
        return center, roll_pitch_yaw(*own.numbers(origin.get("rpy", "0 0 0"), 3, "three angles"))
    if origin.get("rpy") is not None:
        place.refuse("given rpy and quat_xyzw", "give one of them")
    own = place.inner("quat_xyzw")
    if version.strip() not in WITH_QUATERNIONS:
        advice = 'write version="1.2" in <robot>, or rpy'
        own.refuse(f"given in version {version!r}, which ignores it", advice)
    x, y, z, w = own.numbers(quaternion, 4, "a quaternion x y z w")
    return center, of_quaternion([w, x, y, z], own)
