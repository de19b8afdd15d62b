"""How a trace is to be read: units, frames, orders. The project's own are the defaults."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np

from omegadot.commands.units import UNITS, unit_named
from omegadot.harness.usage import UsageError, check_number, nearest
from omegadot.reference_impl.rotations import normalize, rotation_matrix
from omegadot.reference_impl.system import Array
from omegadot.written import written

CHOICES = {
    "omega_frame": ("body", "world"),
    "attitude_is": ("world-from-body", "body-from-world"),
    "point": ("center-of-mass", "origin"),
}
LARGEST = 1e15  # of a component in an argument: no square of it overflows
_SEQUENCE = re.compile(r"([xyz]{3}|[XYZ]{3})$")
_AXIS = re.compile(r"([+-]?)([xyz])$")


@dataclass(frozen=True)
class Convention:
    """What the numbers of a trace mean. A field is named as the option that declares it.

    attitude_is: what the angles, the quaternion or the matrix turns into what.
    euler: three axes as SciPy's Rotation takes them, capitals intrinsic (each about the axes that
    have turned already), small letters extrinsic.  quaternion: the order of its columns.
    point: whose position and velocity are given.
    world_axes and body_axes: (3, 3), a vector's components in the scenario's axes are
    ``world_axes @ theirs`` and ``body_axes @ theirs``.
    time_offset: s, the trace's time at the scenario's start, or a date.
    rate: Hz, of samples without times.  from_time and to_time: s or dates, as the trace has them,
    the window that is used.
    world_rate: (3,) rad/s, the angular velocity of the trace's world in the scenario's, in the
    trace's axes.  world_origin: (3,) m, the origin of the scenario's world as the trace has it.
    omega_bias: (3,) rad/s, a constant that is subtracted from omega, in the trace's axes.
    """

    time_unit: str = "s"
    angle_unit: str = "rad"
    rate_unit: str = "rad/s"
    length_unit: str = "m"
    omega_frame: str = "body"
    attitude_is: str = "world-from-body"
    euler: str = "ZYX"
    quaternion: str = "wxyz"
    point: str = "center-of-mass"
    world_axes: Array = field(default_factory=lambda: np.eye(3))
    body_axes: Array = field(default_factory=lambda: np.eye(3))
    time_offset: float | str = 0.0
    rate: float | None = None
    from_time: float | str | None = None
    to_time: float | str | None = None
    world_rate: Array = field(default_factory=lambda: np.zeros(3))
    world_origin: Array = field(default_factory=lambda: np.zeros(3))
    omega_bias: Array = field(default_factory=lambda: np.zeros(3))

    def scale_of(self, kind: str) -> float:
        """The SI value of the unit of ``time``, ``angle``, ``rate`` or ``length``."""
        return UNITS[kind][getattr(self, f"{kind}_unit")]


_OPTIONS = {"from_time": "from", "to_time": "to"}
SETTINGS = {_OPTIONS.get(f.name, f.name.replace("_", "-")): f.name for f in fields(Convention)}
"""The options that declare a convention, without their dashes in front, and the fields."""
NUMBERS = ("time-offset", "rate", "from", "to")
"""Options that a number may be given for."""


def option_of(name: str) -> str:
    """The option that declares a field of the convention."""
    return "--" + _OPTIONS.get(name, name.replace("_", "-"))


def convention_of(settings: Mapping[str, Any]) -> Convention:
    """The convention of settings by option, with its units as UNITS spells them.

    Raises UsageError.
    """
    given = {SETTINGS[key]: value for key, value in settings.items()}
    for name in {"world_axes", "body_axes"} & set(given):
        given[name] = axes_of(given[name], option_of(name))
    for name in {"world_rate", "world_origin", "omega_bias"} & set(given):
        given[name] = vector_of(given[name], option_of(name))
    rate = given.get("rate")
    if rate is not None:
        check_number("--rate", rate, 0.0)
    found = Convention(**given)
    units: dict[str, Any] = {
        f"{kind}_unit": unit_named(getattr(found, f"{kind}_unit"), kind, f"--{kind}-unit")
        for kind in ("time", "angle", "rate", "length")
    }
    for name, allowed in CHOICES.items():
        argument = getattr(found, name)
        if argument not in allowed:
            advice = nearest(argument, allowed)
            raise UsageError(f"{option_of(name)} {argument}: no such choice; {advice}.")
    found = replace(
        found,
        **units,
        world_rate=UNITS["rate"][units["rate_unit"]] * found.world_rate,
        omega_bias=UNITS["rate"][units["rate_unit"]] * found.omega_bias,
        world_origin=UNITS["length"][units["length_unit"]] * found.world_origin,
    )
    axes = found.euler
    if not (_SEQUENCE.match(axes) and axes[0] != axes[1] != axes[2]):
        raise UsageError(
            f"--euler {axes}: not a sequence of three axes; write ZYX for intrinsic "
            "yaw-pitch-roll, small letters for extrinsic turns."
        )
    return found


def vector_of(text: str, option: str) -> Array:
    """(3,) from ``1.5,0,-2``. Raises UsageError."""
    try:
        parts = np.array([float(part) for part in text.split(",")])
    except ValueError:
        parts = np.full(3, np.nan)
    if parts.shape != (3,) or not np.all(np.abs(parts) <= LARGEST):
        raise UsageError(
            f"{option} {text}: write three numbers of at most {written(LARGEST)}, like 0.1,0,-2."
        )
    return parts


def axes_of(text: str, option: str) -> Array:
    """(3, 3) from ``x,-y,-z``, which of their axes ours are, or a quaternion ``w,x,y,z``.

    Raises UsageError where it is no rotation.
    """
    parts = [part.strip().lower() for part in text.split(",")]
    where, advice = f"{option} {text}", "write three axes like x,-y,-z or a quaternion w,x,y,z"
    if len(parts) == 4:
        try:
            q = np.array([float(part) for part in parts])
        except ValueError:
            raise UsageError(f"{where}: four numbers were expected; {advice}.") from None
        if not (np.all(np.isfinite(q)) and abs(np.sqrt(np.sum(q * q)) - 1.0) < 1e-3):
            raise UsageError(f"{where}: the quaternion is not of unit length; {advice}.")
        return rotation_matrix(normalize(q))
    named = [axis for axis in map(_AXIS.match, parts) if axis]
    if not len(parts) == len(named) == 3:
        raise UsageError(f"{where}: neither three axes nor four numbers; {advice}.")
    matrix = np.zeros((3, 3))
    for row, axis in enumerate(named):
        matrix[row, "xyz".index(axis[2])] = -1.0 if axis[1] == "-" else 1.0
    if abs(np.linalg.det(matrix) - 1.0) > 0.5:
        raise UsageError(f"{where}: no rotation, it mirrors or repeats an axis; {advice}.")
    return matrix


def axes_text(matrix: Array) -> str:
    """The text that `axes_of` reads this matrix from, for one of signed axes."""
    axes = []
    for row in matrix:
        place = int(np.argmax(np.abs(row)))
        axes.append(("-" if row[place] < 0 else "") + "xyz"[place])
    return ",".join(axes)
