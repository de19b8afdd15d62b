"""A pose and a flag as SDF writes them: sdformat.org/tutorials, specify pose."""

from __future__ import annotations

import math
from xml.etree.ElementTree import Element

import numpy as np

from omegadot.scenarios.links.place import Place
from omegadot.scenarios.links.turns import Matrix, of_quaternion, roll_pitch_yaw


def flag(text: str | None, place: Place) -> bool:
    """A truth value; false where none is given."""
    flag = (text or "false").strip().lower()
    if flag not in ("true", "1", "false", "0"):
        place.refuse(repr(text), "write true or false")
    return flag in ("true", "1")


def pose_of(pose: Element | None, place: Place) -> tuple[list[float], Matrix]:
    """A position and a rotation in the link's frame; none given is the frame itself."""
    if pose is None or not (pose.text or "").strip():
        return [0.0, 0.0, 0.0], np.eye(3)
    frame = pose.get("relative_to") or pose.get("frame")
    if frame:
        place.refuse(f"relative to {frame!r}", "give it in the link's own frame")
    form = pose.get("rotation_format", "euler_rpy")
    if form == "quat_xyzw":
        *center, x, y, z, w = place.numbers(pose.text, 7, "a position and a quaternion x y z w")
        return center, of_quaternion([w, x, y, z], place)
    if form != "euler_rpy":
        place.refuse(f"in rotation format {form!r}", "write euler_rpy or quat_xyzw")
    values = place.numbers(pose.text, 6, "x y z roll pitch yaw")
    unit = math.pi / 180.0 if flag(pose.get("degrees"), place.inner("degrees")) else 1.0
    return values[:3], roll_pitch_yaw(*(unit * angle for angle in values[3:]))
