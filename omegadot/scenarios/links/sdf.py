"""A link of an SDF: sdformat.org/spec, element link.

The link's frame is the body's: `pose` places the inertial frame in it. SDF takes 1 kg and a unit
inertia for what is left out; here that is refused, as it is hardly ever meant.
"""

from __future__ import annotations

import math
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np

from omegadot.scenarios.links.place import Place
from omegadot.scenarios.links.turns import (
    Matrix,
    of_quaternion,
    roll_pitch_yaw,
    symmetric,
    turned_tensor,
)


def links(root: Element) -> dict[str, list[Element]]:
    """The links, by name and by ``model::name``."""
    found: dict[str, list[Element]] = {}

    def visit(element: Element, scope: str) -> None:
        for child in element:
            name = child.get("name") or ""
            if child.tag == "link":
                for full in dict.fromkeys((name, f"{scope}{name}")):
                    found.setdefault(full, []).append(child)
            elif child.tag == "model":
                visit(child, f"{scope}{name}::")
            elif child.tag == "world":
                visit(child, scope)

    visit(root, "")
    return found


def body(link: Element, place: Place) -> dict[str, Any]:
    """The link's mass, centre of mass and inertia as a scenario's body. Raises ScenarioError."""
    inertial = place.only(link, "inertial")
    if inertial is None:
        place.refuse("without <inertial>", "give it one or choose another link")
    own = place.inner("inertial")
    if (inertial.get("auto") or "false").strip().lower() in ("true", "1"):
        own.refuse('auto="true", computed from its shapes', "write its mass and inertia out")
    if own.only(inertial, "fluid_added_mass") is not None:
        own.inner("fluid_added_mass").refuse("given", "take it out, there is no fluid here")
    inertia = own.only(inertial, "inertia")
    if inertia is None:
        own.inner("inertia").refuse("missing", "give it")
    center, rotation = _pose(own.only(inertial, "pose"), own.inner("pose"))
    moments = (_moment(inertia, n, own) for n in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
    return {
        "mass": own.inner("mass").number(_text(inertial, "mass", own), "a mass in kg"),
        "center_of_mass": center,
        "inertia": turned_tensor(rotation, symmetric(*moments)),
    }


def _text(element: Element, name: str, place: Place) -> str | None:
    child = place.only(element, name)
    return None if child is None else child.text


def _moment(inertia: Element, name: str, place: Place) -> float:
    own = place.inner(f"inertia {name}")
    text = _text(inertia, name, place)
    if text is None and name in ("ixy", "ixz", "iyz"):
        return 0.0
    return own.number(text, "a number in kg m^2")


def _pose(pose: Element | None, place: Place) -> tuple[list[float], Matrix]:
    if pose is None or not (pose.text or "").strip():
        return [0.0, 0.0, 0.0], np.eye(3)
    frame = pose.get("relative_to") or pose.get("frame")
    if frame:
        place.refuse(f"relative to {frame!r}", "give it in the link's own frame")
    form = pose.get("rotation_format", "euler_rpy")
    if form == "quat_xyzw":
        values = place.numbers(pose.text, 7, "a position and a quaternion x y z w")
        rotation = of_quaternion([values[6], *values[3:6]])
        if rotation is None:
            place.refuse("a quaternion of zeros", "give 0 0 0 1 for no rotation")
        return values[:3], rotation
    if form != "euler_rpy":
        place.refuse(f"in rotation format {form!r}", "write euler_rpy or quat_xyzw")
    values = place.numbers(pose.text, 6, "x y z roll pitch yaw")
    degrees = (pose.get("degrees") or "false").strip().lower() in ("true", "1")
    unit = math.pi / 180.0 if degrees else 1.0
    return values[:3], roll_pitch_yaw(*(unit * angle for angle in values[3:]))
