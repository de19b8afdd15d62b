"""A body of an MJCF: mujoco.readthedocs.io, XML reference, body and inertial.

The body's frame is the one meant: `pos` and the orientation of `inertial` are in it. A body
without `inertial` gets its inertia from its geoms; see `mjcf_geoms` for those that can be read.
"""

from __future__ import annotations

from typing import Any
from xml.etree.ElementTree import Element

import numpy as np

from omegadot.scenarios.links.mjcf_geoms import parts_of
from omegadot.scenarios.links.mjcf_settings import Settings, settings_of
from omegadot.scenarios.links.place import Place
from omegadot.scenarios.links.turns import symmetric, turned_tensor


def links(root: Element) -> dict[str, list[Element]]:
    """The bodies by name."""
    found: dict[str, list[Element]] = {}
    for world in root.findall("worldbody"):
        for body_element in world.iter("body"):
            found.setdefault(body_element.get("name") or "", []).append(body_element)
    return found


def body(element: Element, place: Place, root: Element) -> dict[str, Any]:
    """The body's mass, centre of mass and inertia, or its parts. Raises ScenarioError."""
    settings = settings_of(root, Place(place.file, "compiler"))
    inertial = place.only(element, "inertial")
    if settings.inertia_from_geoms == "true":
        inertial = None
    if inertial is None:
        if settings.inertia_from_geoms == "false":
            place.refuse("without <inertial>, and inertiafromgeom is false", "give it one")
        return {"part": parts_of(element, place, root, settings)}
    return _inertial(inertial, place.inner("inertial"), settings)


def _inertial(inertial: Element, place: Place, settings: Settings) -> dict[str, Any]:
    mass = place.attribute(inertial, "mass")
    center = place.inner("pos").numbers(inertial.get("pos", "0 0 0"), 3, "three numbers")
    rotation = settings.rotation(inertial, place)
    full, moments = inertial.get("fullinertia"), inertial.get("diaginertia")
    if full is not None and moments is not None:
        place.refuse("given diaginertia and fullinertia", "give one of them")
    if full is not None:
        if rotation is not None:
            place.refuse("given fullinertia and an orientation", "leave the orientation out")
        xx, yy, zz, xy, xz, yz = place.inner("fullinertia").numbers(full, 6, "six numbers")
        tensor = symmetric(xx, xy, xz, yy, yz, zz)
    else:
        own = place.inner("diaginertia")
        tensor = np.diag(own.numbers(moments, 3, "diaginertia or fullinertia"))
    turned = turned_tensor(np.eye(3) if rotation is None else rotation, tensor)
    found = {"mass": mass, "center_of_mass": center, "inertia": turned}
    settings.check_bounds(found, place)
    return found
