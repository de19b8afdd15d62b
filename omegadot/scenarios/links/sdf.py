"""A link of an SDF: sdformat.org/spec, element link.

The link's frame is the body's: `pose` places the inertial frame in it. SDF takes 1 kg and a unit
inertia for what is left out; here that is refused, as it is hardly ever meant.
"""

from __future__ import annotations

from functools import partial
from typing import Any
from xml.etree.ElementTree import Element

from omegadot.scenarios.links.link import Link
from omegadot.scenarios.links.place import Place, numbers_in
from omegadot.scenarios.links.poses import MOMENTS, flag, pose_of, turned_tensor
from omegadot.scenarios.links.sdf_shapes import body_of_shapes


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
        return body_of_shapes(link, inertial, place)
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
