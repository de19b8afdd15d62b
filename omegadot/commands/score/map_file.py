"""The options that describe a trace, in a TOML file."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from omegadot.harness.usage import UsageError, nearest

KEYS = (
    "time-unit", "angle-unit", "rate-unit", "length-unit", "omega-frame", "attitude-is", "euler",
    "quaternion", "point", "world-axes", "body-axes", "time-offset",
)  # fmt: skip


@dataclass(frozen=True)
class MapFile:
    """columns: pairs of a role and its columns' names.  settings: by the options' names."""

    columns: list[tuple[str, list[str]]]
    settings: dict[str, Any]


def read_map(path: Path) -> MapFile:
    """The map in a TOML file. Raises UsageError."""
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise UsageError(f"--map {path}: not readable ({error.strerror or error}).") from error
    except (ValueError, RecursionError) as error:
        reason = str(error).splitlines()[0].rstrip(".")
        raise UsageError(f"--map {path}: not valid TOML ({reason}).") from error
    columns = data.pop("columns", {})
    if not isinstance(columns, dict):
        raise UsageError(f"--map {path}: columns must be a table, like [columns] with t = 'time'.")
    for key, value in data.items():
        if key not in KEYS:
            raise UsageError(f"--map {path}: there is no key {key!r}; {nearest(key, KEYS)}.")
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if not (number if key == "time-offset" else isinstance(value, str)):
            expected = "a number" if key == "time-offset" else "a text"
            raise UsageError(f"--map {path}: {key} is {value!r}; give {expected}.")
    return MapFile([(role, _names(path, role, value)) for role, value in columns.items()], data)


def _names(path: Path, role: str, value: object) -> list[str]:
    names: Sequence[object] = value if isinstance(value, list) else [value]
    if not names or not all(isinstance(name, str) and name for name in names):
        raise UsageError(
            f"--map {path}: columns.{role} is {value!r}; give a column's name or a list of them."
        )
    return [str(name) for name in names]
