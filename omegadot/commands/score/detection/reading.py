"""A whole way to read a trace, and the options that request it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from omegadot.commands.score.convention import SETTINGS, axes_text
from omegadot.commands.score.detection.candidates import Attitude, Omega
from omegadot.commands.score.detection.numbers import AXES, SAME
from omegadot.commands.score.named_units import unit_in
from omegadot.harness.usage import UsageError
from omegadot.reference_impl.rotations import rotation_matrix
from omegadot.reference_impl.system import Array

PROBES = 8
MARK = "# Detected by omegadot score --detect."
Option = tuple[str, str | float]


@dataclass(frozen=True)
class Clock:
    """How the time stamps are read.

    column: None where there are none.  offset: s, the trace's time at the scenario's start, a text
    where a float has not all of its digits.  declared: what of `score`'s options is declared.
    """

    column: str | None
    unit: str
    offset: float | str
    declared: tuple[Option, ...] = ()


@dataclass(frozen=True)
class Reading:
    """Clock, attitude and omega, as far as the trace has them."""

    clock: Clock
    attitude: Attitude | None
    omega: Omega | None

    @property
    def misfit(self) -> float:
        """The larger of the two."""
        return max(part.misfit for part in self.parts)

    @property
    def parts(self) -> list[Attitude | Omega]:
        """What it reads of a motion."""
        return [part for part in (self.attitude, self.omega) if part is not None]

    @property
    def plainness(self) -> tuple[object, ...]:
        """For ordering readings that fit alike."""
        parts = [part.plainness if part else () for part in (self.attitude, self.omega)]
        return (self.clock.unit != "s", self.clock.offset != 0.0, *parts)

    def options(self) -> list[str]:
        """The options to pass to have the trace read so."""
        return [_option(key, value) for key, value in self._options()]

    def arguments(self) -> dict[str, Any]:
        """The same as keyword arguments of `omegadot.score`."""
        options = self._options()
        settings = {SETTINGS[k]: value for k, value in options if k != "column"}
        return {"columns": [value for k, value in options if k == "column"], **settings}

    def map_text(self) -> str:
        """The same as a file for ``--map``."""
        given = self.arguments()
        pairs = [one.partition("=")[::2] for one in given.pop("columns")]
        columns = [f"{role} = {_toml(names.split(','))}" for role, names in pairs]
        keys = {option: key for key, option in SETTINGS.items()}
        settings = [f"{keys[name]} = {_toml(value)}" for name, value in given.items()]
        return "\n".join([MARK, *settings, "\n[columns]", *columns]) + "\n"

    def _options(self) -> list[Option]:
        clock = self.clock
        found: list[Option] = [("column", f"t={clock.column}")] * (clock.column is not None)
        found += clock.declared
        found += _unit("time-unit", clock.unit, "s", "t", (clock.column or "",))
        found += [("time-offset", self.clock.offset)] * (self.clock.offset != 0.0)
        world = body = SAME
        if self.omega is not None:
            found.append(("column", f"w={','.join(self.omega.columns)}"))
            found += _unit("rate-unit", self.omega.unit, "rad/s", "w", self.omega.columns)
            found += [("omega-frame", "world")] * (self.omega.frame == "world")
            body = self.omega.axes if self.omega.frame == "body" else SAME
        if self.attitude is not None:
            found += _attitude_options(self.attitude)
            world, body = self.attitude.world, self.attitude.body
        for name, axes in (("world", world), ("body", body)):
            found += [(f"{name}-axes", axes_text(AXES[axes]))] * (axes != SAME)
        return found


def _unit(option: str, unit: str, default: str, role: str, names: Sequence[str]) -> list[Option]:
    """The option of a unit where another would be taken without it: the names' own, or SI's."""
    own = default
    for name in names:
        try:
            own = unit_in(name, role) or own
        except UsageError:  # it has one of another quantity, and the option is needed
            own = ""
    return [(option, unit)] * (unit != own)


def _option(key: str, value: str | float) -> str:
    if key == "column":
        return f"--column '{value}'"
    if key.endswith("-axes"):  # it may begin with a minus
        return f"--{key}={value}"
    return f"--{key} {value}"


def _toml(value: object) -> str:
    return json.dumps(value, ensure_ascii=False)


def _attitude_options(found: Attitude) -> list[Option]:
    names, options = ",".join(found.columns), list[Option]()
    if found.kind.startswith("quaternion"):
        options = [("column", f"q={names}"), ("quaternion", found.kind.split()[1])]
    elif found.kind == "matrix":
        options = [("column", f"r={names}")]
    else:
        options = [("column", f"e={names}"), ("euler", found.kind)]
        options += _unit("angle-unit", found.unit, "rad", "e", found.columns)
    return options + [("attitude-is", found.direction)] * (found.direction != "world-from-body")


def unlike(readings: Sequence[Reading]) -> list[Reading]:
    """The plainest of those that are the same reading in another form.

    They are if they read any numbers alike: random ones are put into the columns, and read.
    """
    random, kept = np.random.default_rng(0), dict[tuple[object, ...], Reading]()
    names = sorted({n for reading in readings for part in reading.parts for n in part.columns})
    probe: dict[str, Array] = {name: random.uniform(-50.0, 50.0, PROBES) for name in names}
    for reading in readings:
        kept.setdefault((reading.clock, *_read(reading, probe)), reading)
    return list(kept.values())


def _read(reading: Reading, probe: dict[str, Array]) -> list[object]:
    """What a reading makes of random numbers, coarse enough for roundings to agree."""
    parts: list[object] = []
    q = None
    attitude = reading.attitude
    if attitude is not None and attitude.kind == "matrix":  # random numbers are none
        parts = [attitude.columns, attitude.direction, attitude.world, attitude.body]
    elif attitude is not None:
        q = attitude.read(probe)
        parts = [tuple(np.round(rotation_matrix(q), 6).ravel() + 0.0)]
    if reading.omega is not None:
        parts.append(tuple(np.round(reading.omega.read(probe, q), 6).ravel() + 0.0))
        parts.append(reading.omega.frame if q is None else "")
    return parts
