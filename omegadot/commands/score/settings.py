"""How a trace is declared to be read: columns and settings, in the arguments and in a TOML file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime, time
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from omegadot.commands.score.columns import GROUPS, Columns, assignments_of, columns_of
from omegadot.commands.score.convention import (
    NUMBERS,
    SETTINGS,
    Convention,
    convention_of,
    option_of,
)
from omegadot.commands.score.digits import longest, open_of, shared_digits
from omegadot.commands.score.named_units import named_units
from omegadot.commands.score.stamps import Stamps, counted, in_window, instant, stamps_of
from omegadot.commands.score.table import Column, Table, TraceError
from omegadot.harness.usage import UsageError, nearest
from omegadot.reference_impl.system import Array
from omegadot.scenarios.errors import ScenarioError
from omegadot.scenarios.files import read_toml

GivenColumns = Mapping[str, str | Sequence[str]] | Sequence[str]
"""Names by role, ``{"t": "time", "w": ["p", "q", "r"]}``, or texts such as ``w=p,q,r``."""
Assigned = list[tuple[str, list[str]]]
"""Pairs of a role, or a group of roles, and the names of its columns."""


@dataclass(frozen=True)
class Reading:
    """A trace's file and how it is read.

    named: by option, such as ``rate-unit``, the column whose name has that unit.  declared: the
    options that are given.
    """

    table: Table
    columns: Columns
    how: Convention
    named: Mapping[str, str] = field(default_factory=dict)
    declared: frozenset[str] = frozenset()

    def advice(self, unit_field: str, unit: str) -> str:
        """How to have another unit taken: by its option, or where a name has one, by that."""
        option = option_of(unit_field)
        name = self.named.get(option.removeprefix("--"))
        if name is None:
            return f"give {option} {unit}"
        return f"correct the unit in the name of column {name!r}"

    def origin(self, unit_field: str) -> str:
        """The unit of a field, and where it is from, for a sentence."""
        option = option_of(unit_field)
        key, unit = option.removeprefix("--"), getattr(self.how, unit_field)
        if key in self.named:
            return f"{unit} (by the name of column {self.named[key]!r})"
        return f"{unit} ({f'by {option}' if key in self.declared else 'the default'})"

    @cached_property
    def stamps(self) -> Stamps:
        """The samples' times in the trace's own time. Raises TraceError."""
        if self.how.rate is not None:
            return counted(self.table, self.how.rate)
        return stamps_of(self.table, self.columns["t"], self.how.scale_of("time"))

    @property
    def timed(self) -> bool:
        """Whether its times are numbers, in a unit that may be another."""
        return self.how.rate is None and not self.stamps.dated

    @property
    def times(self) -> Array:
        """(n,) s since the scenario's start."""
        return self.stamps.since(instant(self.how.time_offset, "--time-offset"))

    def part(self, inside: NDArray[np.bool_]) -> Reading:
        """The samples for which `inside`, (n,), is true."""
        return replace(self, table=self.table.part(inside))

    @cached_property
    def _writer(self) -> tuple[int, int]:
        """The digits that the columns other than the time share."""
        names = dict.fromkeys(name for role, name in self.columns.items() if role != "t")
        parts = [self.table.column(name) for name in names]
        texts = [part.texts for part in parts if part.texts is not None]
        return shared_digits(texts, [part.values for part in parts if part.texts is not None])

    def _open(self, column: Column) -> Array:
        values, texts = column.values, column.texts
        if texts is None or np.any(values != values[0]):
            return column.open
        own = longest(texts)
        return open_of(texts, values, (max(own[0], self._writer[0]), max(own[1], self._writer[1])))

    def group(self, name: str) -> tuple[Array, Array] | None:
        """(n, k): the columns of a group in the order of its roles, and their resolution.

        None where the group is not given; a column of it that is not is NaN, with nothing open.
        """
        roles = GROUPS[name]
        if not any(role in self.columns for role in roles):
            return None
        values = np.full((len(roles), len(self.table)), np.nan)
        opened = np.zeros_like(values)
        for place, role in enumerate(roles):
            if role in self.columns:
                column = self.table.column(self.columns[role])
                values[place], opened[place] = column.values, self._open(column)
        return values.T, opened.T


def reading_of(
    table: Table, columns: GivenColumns, map_file: Path | None, settings: Mapping[str, Any]
) -> Reading:
    """The trace's columns and convention, in its window. Raises UsageError and TraceError."""
    assigned, declared = settings_of(columns, map_file, settings)
    how = convention_of(declared)
    timed = how.rate is None
    roles = columns_of(table, assigned, how.quaternion, how.euler, timed)
    options = {key: getattr(how, SETTINGS[key]) for key in declared}
    named = named_units(table, roles, options)
    how = convention_of({**declared, **{option: unit for option, (unit, _) in named.items()}})
    names = {option: name for option, (_, name) in named.items()}
    found = Reading(table, roles, how, names, frozenset(declared))
    first, last = (
        None if text is None else instant(text, option)
        for text, option in ((how.from_time, "--from"), (how.to_time, "--to"))
    )
    if first is None and last is None:
        return found
    inside = in_window(found.stamps, first, last)
    if np.sum(inside) < 2:
        own = found.stamps
        raise TraceError(
            f"{table.file}: --from and --to leave {np.sum(inside)} of the samples, which run from "
            f"{own.text(0)} to {own.text(-1)} s; give a window with at least two."
        )
    return found.part(inside)


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
        data = read_toml(path, f"--map {path}")
    except ScenarioError as error:
        raise UsageError(str(error)) from None
    columns = data.pop("columns", {})
    instants = {k: v for k, v in data.items() if isinstance(v, datetime | time)}
    data |= {key: value.isoformat() for key, value in instants.items()}
    if not isinstance(columns, dict):
        raise UsageError(f"--map {path}: columns must be a table, like [columns] with t = 'time'.")
    for key, value in data.items():
        if key not in SETTINGS:
            raise UsageError(f"--map {path}: there is no key {key!r}; {nearest(key, SETTINGS)}.")
        number = isinstance(value, int | float) and not isinstance(value, bool)
        fits = isinstance(value, str) and key != "rate"
        if not (fits or (number and key in NUMBERS)):
            expected = "a number" if key in NUMBERS else "a text"
            raise UsageError(f"--map {path}: {key} is {value!r}; give {expected}.")
    for role, value in columns.items():
        names = value if isinstance(value, list) else [value]
        if not all(isinstance(name, str) and name for name in names):
            raise UsageError(
                f"--map {path}: columns.{role} is {value!r}; give a column's name or a list of "
                "them."
            )
    return [(role, _names(value)) for role, value in columns.items()], data
