"""What is required of an engine: how exact, how fast, and which properties."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Literal

from omegadot.adapters import protocol
from omegadot.commands.units import UNITS, quantity, unit_written
from omegadot.harness.usage import UsageError, nearest
from omegadot.scenarios.errors import ScenarioError
from omegadot.scenarios.files import read_toml

Precision = Literal["double", "single"]
# Requirement: the kind of its quantity, and the unit in which it is kept and shown.
ACCURACY: dict[str, tuple[str, str]] = {
    "attitude": ("angle", "rad"),
    "omega": ("rate", "rad/s"),
    "energy-drift": ("ratio", "1"),
    "momentum-drift": ("ratio", "1"),
    "linear-momentum-drift": ("ratio", "1"),
    "flip-time": ("time", "s"),
}
FEATURES = tuple(name.replace("_", "-") for name in protocol.FEATURES)
PRECISIONS: dict[str, Precision] = {
    "double": "double", "float64": "double", "single": "single", "float32": "single"
}  # fmt: skip


@dataclass(frozen=True)
class Requirements:
    """limits: the greatest error by requirement, SI.  duration: s, None for the scenario's own.

    requested: every limit as it was written.  licences: those allowed, any when empty.
    """

    limits: dict[str, float]
    requested: dict[str, str]
    real_time_factor: float | None = None
    precision: Precision | None = None
    features: tuple[str, ...] = ()
    licences: tuple[str, ...] = ()
    python: str | None = None
    duration: float | None = None

    def shown(self, key: str) -> dict[str, Any]:
        """The unit that a limit was written in, by name and in SI: in it errors are shown."""
        kind, _ = ACCURACY[key]
        unit = unit_written(self.requested[key], kind, f"--{key}")
        return {"unit": unit, "si": UNITS[kind][unit]}


def _texts(value: object, where: str) -> list[str]:
    items = value if isinstance(value, list | tuple) else [value]
    if not all(isinstance(item, str) for item in items):
        raise UsageError(f"{where} is {value!r}; give a text or a list of texts.")
    return [str(item) for item in items]


def _features(value: object, where: str) -> tuple[str, ...]:
    found = [text.strip().replace("_", "-") for text in _texts(value, where)]
    for name in found:
        if name not in FEATURES:
            raise UsageError(f"{where}: there is no feature {name!r}; {nearest(name, FEATURES)}.")
    return tuple(dict.fromkeys(found))


def _precision(value: object, where: str) -> Precision:
    found = PRECISIONS.get(str(value))
    if found is None:
        raise UsageError(f"{where}: {value!r} is no precision; write double or single.")
    return found


def _python(value: object, where: str) -> str:
    if not isinstance(value, str) or not re.fullmatch(r"3\.\d{1,2}", value.strip()):
        raise UsageError(f'{where}: {value!r} is no Python version; write it as "3.12".')
    return value.strip()


def _licences(value: object, where: str) -> tuple[str, ...]:
    found = _texts(value, where)
    if not all(text.strip() for text in found):
        raise UsageError(f"{where}: an empty name; give one such as Apache-2.0.")
    return tuple(dict.fromkeys(text.strip() for text in found))


# By key: the field of Requirements, and what reads its value.
READERS: dict[str, tuple[str, Callable[..., Any]]] = {
    "real-time-factor": ("real_time_factor", partial(quantity, kind="factor")),
    "precision": ("precision", _precision),
    "feature": ("features", _features),
    "licence": ("licences", _licences),
    "python": ("python", _python),
    "duration": ("duration", partial(quantity, kind="time")),
}
KEYS = (*ACCURACY, *READERS)


def known_key(name: str, where: str) -> str:
    """The requirement that a key of a file names. Raises UsageError with the nearest name."""
    aliases = {"features": "feature", "licences": "licence", "license": "licence"}
    key = name.replace("_", "-")
    key = aliases.get(key, key)
    if key not in KEYS:
        raise UsageError(f"{where}: there is no requirement {name!r}; {nearest(key, KEYS)}.")
    return key


def merged(file: Mapping[str, Any], line: Mapping[str, Any], path: str) -> Requirements:
    """The file's requirements with those of the command line over them, values as written.

    Raises UsageError, also where no accuracy is required: without one every step is good enough.
    """
    typed = {
        k: v for k, v in line.items() if not (v is None or (isinstance(v, str | list) and not v))
    }
    given = {**file, **typed}
    places = {key: f"--{key}" if key in typed else f"{path}: {key}" for key in given}
    accuracy = [key for key in ACCURACY if key in given]
    limits = {key: quantity(given[key], ACCURACY[key][0], places[key]) for key in accuracy}
    if not limits:
        named = ", ".join(f"--{key}" for key in ACCURACY)
        raise UsageError(f"no accuracy is required; give at least one of {named}.")
    rest: dict[str, Any] = {
        field: reader(given[key], where=places[key])
        for key, (field, reader) in READERS.items()
        if key in given
    }
    return Requirements(limits, {key: str(given[key]) for key in accuracy}, **rest)


def read_requirements(path: Path) -> dict[str, Any]:
    """Keys and values of the file, values as written. Raises UsageError, one sentence."""
    try:
        data = read_toml(path, str(path))
    except ScenarioError as error:
        raise UsageError(str(error)) from None
    found: dict[str, Any] = {}
    for name, value in data.items():
        key = known_key(name, str(path))
        if key in found:
            raise UsageError(f"{path}: {key} is given twice; give it once.")
        found[key] = value
    return found
