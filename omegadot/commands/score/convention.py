"""How a trace is to be read: units, frames, orders. The project's own are the defaults."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np

from omegadot.commands.units import UNITS, unit_named
from omegadot.harness.usage import UsageError, nearest
from omegadot.reference_impl.system import Array

FRAMES = ("body", "world")
DIRECTIONS = ("world-from-body", "body-from-world")
POINTS = ("center-of-mass", "origin")
_SEQUENCE = re.compile(r"([xyz]{3}|[XYZ]{3})$")
_AXIS = re.compile(r"([+-]?)([xyz])$")


def _same() -> Array:
    return np.eye(3)


@dataclass(frozen=True)
class Convention:
    """What the numbers of a trace mean.

    euler: three axes as SciPy's Rotation takes them, capitals intrinsic (each about the axes that
    have turned already), small letters extrinsic.  attitude: what the angles, the quaternion or
    the matrix turns into what.  point: whose position and velocity are given.
    world and body: (3, 3), a vector's components in the scenario's axes are ``world @ theirs`` and
    ``body @ theirs``.  time_offset: s, the trace's time at the scenario's start.
    """

    time_unit: str = "s"
    angle_unit: str = "rad"
    rate_unit: str = "rad/s"
    length_unit: str = "m"
    omega_frame: str = "body"
    attitude: str = "world-from-body"
    euler: str = "ZYX"
    point: str = "center-of-mass"
    world: Array = field(default_factory=_same)
    body: Array = field(default_factory=_same)
    time_offset: float = 0.0

    def scale_of(self, kind: str) -> float:
        """The SI value of the unit of ``time``, ``angle``, ``rate`` or ``length``."""
        return UNITS[kind][getattr(self, f"{kind}_unit")]


def check_convention(found: Convention) -> Convention:
    """The convention with its units as UNITS spells them. Raises UsageError."""
    units: dict[str, Any] = {
        f"{kind}_unit": unit_named(getattr(found, f"{kind}_unit"), kind, f"--{kind}-unit")
        for kind in ("time", "angle", "rate", "length")
    }
    for name, allowed in (
        ("omega_frame", FRAMES),
        ("attitude", DIRECTIONS),
        ("point", POINTS),
    ):
        argument = getattr(found, name)
        if argument not in allowed:
            option = OPTIONS[name]
            raise UsageError(f"{option} {argument}: no such choice; {nearest(argument, allowed)}.")
    check_sequence(found.euler)
    return replace(found, **units)


OPTIONS = {
    **{f.name: "--" + f.name.replace("_", "-") for f in fields(Convention)},
    "attitude": "--attitude-is",
    "world": "--world-axes",
    "body": "--body-axes",
}


def check_sequence(text: str) -> str:
    """An Euler sequence: three axes of one case, neighbours different. Raises UsageError."""
    different = text[:1] != text[1:2] and text[1:2] != text[2:3]
    if not (_SEQUENCE.match(text) and different):
        raise UsageError(
            f"--euler {text}: not a sequence of three axes; write ZYX for intrinsic "
            "yaw-pitch-roll, small letters for extrinsic turns."
        )
    return text


def axes_of(text: str, option: str) -> Array:
    """(3, 3) from ``x,-y,-z``, which of their axes ours are, or a quaternion ``w,x,y,z``.

    Raises UsageError where it is no rotation.
    """
    parts = [part.strip().lower() for part in text.split(",")]
    advice = "write three axes like x,-y,-z or a quaternion w,x,y,z"
    if len(parts) == 4:
        return _from_quaternion(parts, text, option, advice)
    named = [_AXIS.match(part) for part in parts]
    if len(parts) != 3 or not all(named):
        raise UsageError(f"{option} {text}: neither three axes nor four numbers; {advice}.")
    matrix = np.zeros((3, 3))
    for row, axis in enumerate(named):
        if axis is not None:
            matrix[row, "xyz".index(axis.group(2))] = -1.0 if axis.group(1) == "-" else 1.0
    if abs(np.linalg.det(matrix) - 1.0) > 0.5:
        raise UsageError(f"{option} {text}: no rotation, it mirrors or repeats an axis; {advice}.")
    return matrix


def _from_quaternion(parts: list[str], text: str, option: str, advice: str) -> Array:
    from omegadot.reference_impl.rotations import normalize, rotation_matrix

    try:
        q = np.array([float(part) for part in parts])
    except ValueError:
        raise UsageError(f"{option} {text}: four numbers were expected; {advice}.") from None
    if not (np.all(np.isfinite(q)) and abs(np.sqrt(np.sum(q * q)) - 1.0) < 1e-3):
        raise UsageError(f"{option} {text}: the quaternion is not of unit length; {advice}.")
    return rotation_matrix(normalize(q))


def axes_text(matrix: Array) -> str:
    """The text that `axes_of` reads this matrix from, for one of signed axes."""
    axes = []
    for row in matrix:
        place = int(np.argmax(np.abs(row)))
        axes.append(("-" if row[place] < 0 else "") + "xyz"[place])
    return ",".join(axes)
