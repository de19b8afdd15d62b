"""Rotations and poses as robot files write them, and an inertia turned by one.

Poses and flags are SDF's: sdformat.org/tutorials, specify pose.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from omegadot.scenarios.links.place import Place
from omegadot.scenarios.quantities import read_quaternion
from omegadot.scenarios.solids import rotation_of

Matrix = NDArray[np.float64]
MOMENTS = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


def _about(axis: int, angle: float) -> Matrix:
    """The rotation by `angle` rad about the axis x, y or z."""
    c, s = math.cos(angle), math.sin(angle)
    turned = np.eye(3)
    y, z = (axis + 1) % 3, (axis + 2) % 3
    turned[y, y], turned[y, z], turned[z, y], turned[z, z] = c, -s, s, c
    return turned


def roll_pitch_yaw(roll: float, pitch: float, yaw: float) -> Matrix:
    """``Rz(yaw) Ry(pitch) Rx(roll)``: about fixed x, y, z in turn, as URDF and SDF define."""
    found: Matrix = _about(2, yaw) @ _about(1, pitch) @ _about(0, roll)
    return found


def of_quaternion(quaternion: list[float], place: Place) -> Matrix:
    """The rotation of (w, x, y, z) once it is made unit; zero is refused."""
    if not any(quaternion):
        place.refuse("a quaternion of zeros", "give 0 0 0 1 for no rotation")
    return rotation_of(read_quaternion(quaternion))


def turned_tensor(rotation: Matrix, moments: Iterable[float]) -> list[list[float]]:
    """``R I R^T``, symmetric to the last digit. moments: those of I, in the order of `MOMENTS`."""
    xx, xy, xz, yy, yz, zz = moments
    found = rotation @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ rotation.T
    rows: list[list[float]] = (0.5 * (found + found.T)).tolist()
    return rows


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
