"""A body's simple geoms as parts: MuJoCo takes the inertia from them where none is given.

Simple are boxes, balls, cylinders, ellipsoids and capsules that say everything themselves. Classes
of defaults, meshes, `fromto` and shells would need MuJoCo's own compiler.
"""

from __future__ import annotations

from typing import Any
from xml.etree.ElementTree import Element

from omegadot.scenarios.links.mjcf_settings import Settings
from omegadot.scenarios.links.place import Place
from omegadot.scenarios.links.turns import quaternion_of

DENSITY = 1000.0  # kg/m^3, MuJoCo's where a geom gives neither mass nor density
SIZES = {"box": 3, "sphere": 1, "cylinder": 2, "ellipsoid": 3, "capsule": 2}
ADVICE = "write an <inertial>, as MuJoCo's compiled model holds it"


def parts_of(
    body: Element, place: Place, root: Element, settings: Settings
) -> list[dict[str, Any]]:
    """The parts of a body whose geoms are all simple. Raises ScenarioError."""
    geoms = body.findall("geom")
    if not geoms:
        place.refuse("without <inertial> and without geoms", "give it an <inertial>")
    if body.find("frame") is not None or body.find("composite") is not None:
        place.refuse("without <inertial>, its geoms in frames or composites", ADVICE)
    if any(default.find(".//geom") is not None for default in root.findall("default")):
        place.refuse("without <inertial>, its geoms under the file's defaults", ADVICE)
    if any(c.get("inertiagrouprange") for c in root.findall("compiler")):
        place.refuse("without <inertial>, under inertiagrouprange", ADVICE)
    parts = [_part(geom, place.inner(f"geom[{i}]"), settings) for i, geom in enumerate(geoms)]
    return [part for part in parts if part is not None]


def _part(geom: Element, place: Place, settings: Settings) -> dict[str, Any] | None:
    shape = geom.get("type", "sphere")
    if shape not in SIZES:
        place.refuse(f"of type {shape!r}, and the body has no <inertial>", ADVICE)
    for name in ("class", "fromto", "mesh", "shellinertia"):
        if geom.get(name) is not None:
            place.refuse(f"given {name}, and the body has no <inertial>", ADVICE)
    what = f"{SIZES[shape]} half sizes in m"
    sizes = place.inner("size").numbers(geom.get("size"), (SIZES[shape], 3), what)
    rotation = settings.rotation(geom, place)
    part: dict[str, Any] = {
        "shape": shape,
        "position": place.inner("pos").numbers(geom.get("pos", "0 0 0"), 3, "three numbers"),
        "orientation": [1.0, 0.0, 0.0, 0.0] if rotation is None else list(quaternion_of(rotation)),
    }
    if geom.get("mass") is not None:
        part["mass"] = place.attribute(geom, "mass")
    else:
        density = geom.get("density", str(DENSITY))
        part["density"] = place.inner("density").number(density, "a density in kg/m^3")
    if part.get("mass", part.get("density")) == 0.0:  # a shape that is only looked at
        return None
    return {**part, **_sizes(shape, sizes)}


def _sizes(shape: str, sizes: list[float]) -> dict[str, Any]:
    """MuJoCo's half sizes as a part's."""
    match shape:
        case "box":
            return {"size": [2.0 * half for half in sizes]}
        case "sphere":
            return {"radius": sizes[0]}
        case "ellipsoid":
            return {"semi_axes": sizes}
    return {"radius": sizes[0], "length": 2.0 * sizes[1]}
