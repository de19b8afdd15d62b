"""The settings of an MJCF's <compiler> that change a body's inertia or the reading of angles."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np

from omegadot.scenarios.links.place import Place
from omegadot.scenarios.links.turns import Matrix, about, of_quaternion

ORIENTATIONS = ("quat", "axisangle", "xyaxes", "zaxis", "euler")


@dataclass(frozen=True)
class Settings:
    """angle: rad that one unit of an angle in the file is.

    sequence: the axes of `euler`, lower case turning with the body, upper case fixed.
    """

    angle: float
    sequence: str
    inertia_from_geoms: str
    least_mass: float
    least_moment: float

    def rotation(self, element: Element, place: Place) -> Matrix | None:
        """The orientation that an element gives in one of five ways; None where in none."""
        given = [name for name in ORIENTATIONS if element.get(name) is not None]
        if len(given) > 1:
            place.refuse(f"given {' and '.join(given)}", "give one orientation")
        if not given:
            return None
        own = place.inner(given[0])
        rotation = self._read(given[0], element.get(given[0]), own)
        if rotation is None or not np.all(np.isfinite(rotation)):
            own.refuse("no orientation", "give one other than zero")
        return rotation

    def _read(self, name: str, text: str | None, place: Place) -> Matrix | None:
        if name == "quat":
            return of_quaternion(place.numbers(text, 4, "a quaternion w x y z"))
        if name == "axisangle":
            *axis, angle = place.numbers(text, 4, "an axis and an angle")
            return _about_axis(np.array(axis), angle * self.angle)
        if name == "xyaxes":
            values = np.array(place.numbers(text, 6, "an x axis and a y axis"))
            return _of_axes(values[:3], values[3:])
        if name == "zaxis":
            return _to_z(np.array(place.numbers(text, 3, "a z axis")))
        rotation = np.eye(3)
        for letter, angle in zip(
            self.sequence, place.numbers(text, 3, "three angles"), strict=True
        ):
            turn = about(letter.lower(), angle * self.angle)
            rotation = rotation @ turn if letter.islower() else turn @ rotation
        return rotation

    def check_bounds(self, body: dict[str, Any], place: Place) -> None:
        """Refuse a body that boundmass or boundinertia would change."""
        least = float(np.min(np.linalg.eigvalsh(np.array(body["inertia"]))))
        if body["mass"] < self.least_mass or least < self.least_moment:
            place.refuse("below the compiler's boundmass or boundinertia", "write it out in full")


def settings_of(root: Element, place: Place) -> Settings:
    """The settings of all <compiler> elements, later ones over earlier. Raises ScenarioError."""
    given: dict[str, str] = {}
    for compiler in root.findall("compiler"):
        given |= compiler.attrib
    if place.number(given.get("settotalmass", "-1"), "a number") > 0.0:
        place.inner("settotalmass").refuse("set", "take it out, it changes every mass")
    angle = given.get("angle", "degree")
    if angle not in ("degree", "radian"):
        place.inner("angle").refuse(repr(angle), "write degree or radian")
    sequence = given.get("eulerseq", "xyz")
    if len(sequence) != 3 or not set(sequence.lower()) <= set("xyz"):
        place.inner("eulerseq").refuse(repr(sequence), "write three of x, y, z, X, Y and Z")
    return Settings(
        math.pi / 180.0 if angle == "degree" else 1.0,
        sequence,
        given.get("inertiafromgeom", "auto"),
        place.inner("boundmass").number(given.get("boundmass", "0"), "a number"),
        place.inner("boundinertia").number(given.get("boundinertia", "0"), "a number"),
    )


def _about_axis(axis: Matrix, angle: float) -> Matrix | None:
    size = float(np.linalg.norm(axis))
    if size == 0.0:
        return None
    half = 0.5 * angle
    return of_quaternion([math.cos(half), *(math.sin(half) * axis / size)])


def _of_axes(x: Matrix, y: Matrix) -> Matrix:
    """The axes x and y, made unit and perpendicular, and their product."""
    with np.errstate(all="ignore"):
        x = x / np.linalg.norm(x)
        y = y - x * (x @ y)
        y = y / np.linalg.norm(y)
        return np.column_stack([x, y, np.cross(x, y)])


def _to_z(axis: Matrix) -> Matrix | None:
    """The smallest rotation that takes z to the axis."""
    size = float(np.linalg.norm(axis))
    if size == 0.0:
        return None
    x, y, z = axis / size
    across = math.hypot(x, y)
    if across == 0.0:
        return np.eye(3) if z > 0.0 else about("x", math.pi)
    return _about_axis(np.array([-y, x, 0.0]), math.atan2(across, z))
