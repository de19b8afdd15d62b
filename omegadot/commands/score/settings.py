"""How a trace is declared to be read: columns and settings, in the arguments and in a TOML file."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from omegadot.commands.score.columns import GROUPS, Columns, assignments_of, columns_of
from omegadot.commands.score.convention import SETTINGS, Convention, convention_of
from omegadot.commands.score.table import Table
from omegadot.harness.usage import UsageError, nearest
from omegadot.reference_impl.system import Array

GivenColumns = Mapping[str, str | Sequence[str]] | Sequence[str]
"""Names by role, ``{"t": "time", "w": ["p", "q", "r"]}``, or texts such as ``w=p,q,r``."""
Assigned = list[tuple[str, list[str]]]
"""Pairs of a role, or a group of roles, and the names of its columns."""


@dataclass(frozen=True)
class Reading:
    """A trace's file and how it is read."""

    table: Table
    columns: Columns
    how: Convention

    def group(self, name: str) -> tuple[Array, Array] | None:
        """(n, k): the columns of a group in the order of its roles, and their resolution.

        None where the group is not given.
        """
        if GROUPS[name][0] not in self.columns:
            return None
        parts = [self.table.column(self.columns[role]) for role in GROUPS[name]]
        opened = np.stack([part.open for part in parts], axis=-1)
        return np.stack([part.values for part in parts], axis=-1), opened


def reading_of(
    table: Table, columns: GivenColumns, map_file: Path | None, settings: Mapping[str, Any]
) -> Reading:
    """The trace's columns and convention. Raises UsageError and TraceError."""
    assigned, declared = settings_of(columns, map_file, settings)
    how = convention_of(declared)
    return Reading(table, columns_of(table, assigned, how.quaternion, how.euler), how)


def settings_of(
    columns: GivenColumns, map_file: Path | None, settings: Mapping[str, Any]
) -> tuple[Assigned, dict[str, Any]]:
    """Columns and settings, those given here before the map's. Raises UsageError.

    settings: by option, None where nothing is declared.
    """
    if isinstance(columns, Mapping):
        own = [(role, _names(names)) for role, names in columns.items()]
    else:
        own = assignments_of(_names(columns))
    given = {key: value for key, value in settings.items() if value is not None}
    if map_file is None:
        return own, given
    mapped, more = _read_map(map_file)
    declared = {role for role, _ in own}
    return own + [pair for pair in mapped if pair[0] not in declared], {**more, **given}


def _names(names: str | Sequence[str]) -> list[str]:
    return [names] if isinstance(names, str) else list(names)


def _read_map(path: Path) -> tuple[Assigned, dict[str, Any]]:
    """Columns and settings of a TOML file. Raises UsageError."""
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
        if key not in SETTINGS:
            raise UsageError(f"--map {path}: there is no key {key!r}; {nearest(key, SETTINGS)}.")
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if not (number if key == "time-offset" else isinstance(value, str)):
            expected = "a number" if key == "time-offset" else "a text"
            raise UsageError(f"--map {path}: {key} is {value!r}; give {expected}.")
    for role, value in columns.items():
        names = value if isinstance(value, list) else [value]
        if not names or not all(isinstance(name, str) and name for name in names):
            raise UsageError(
                f"--map {path}: columns.{role} is {value!r}; give a column's name or a list of "
                "them."
            )
    return [(role, _names(value)) for role, value in columns.items()], data
