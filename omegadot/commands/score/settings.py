"""How a trace is declared to be read: columns and settings, in the arguments and in a map."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from omegadot.commands.score.columns import assignments_of, columns_of
from omegadot.commands.score.convention import (
    Convention,
    axes_of,
    check_convention,
    check_sequence,
)
from omegadot.commands.score.judged import Reading
from omegadot.commands.score.map_file import read_map
from omegadot.commands.score.table import Table

DEFAULT_ORDER = "wxyz"
Columns = Mapping[str, str | Sequence[str]] | Sequence[str]
"""Names by role, ``{"t": "time", "w": ["p", "q", "r"]}``, or texts such as ``w=p,q,r``."""


@dataclass(frozen=True)
class Declaration:
    """Columns, a map, and settings by option name; None where nothing is declared."""

    columns: Columns = ()
    map_file: Path | None = None
    settings: Mapping[str, Any] = field(default_factory=dict)


def settings_of(declaration: Declaration) -> tuple[list[tuple[str, list[str]]], dict[str, Any]]:
    """Columns and settings, those declared here before the map's. Raises UsageError."""
    if isinstance(declaration.columns, Mapping):
        own = [(role, _names(names)) for role, names in declaration.columns.items()]
    else:
        own = assignments_of(_names(declaration.columns))
    given = {key: value for key, value in declaration.settings.items() if value is not None}
    if declaration.map_file is None:
        return own, given
    mapped = read_map(declaration.map_file)
    declared = {role for role, _ in own}
    kept = [(role, names) for role, names in mapped.columns if role not in declared]
    return own + kept, {**mapped.settings, **given}


def _names(names: str | Sequence[str]) -> list[str]:
    return [names] if isinstance(names, str) else list(names)


def convention_of(settings: Mapping[str, Any]) -> Convention:
    """The convention that the settings declare. Raises UsageError."""
    fields = {
        key.replace("-", "_"): value
        for key, value in settings.items()
        if key not in ("quaternion", "world-axes", "body-axes", "attitude-is")
    }
    if "attitude-is" in settings:
        fields["attitude"] = settings["attitude-is"]
    for key in ("world", "body"):
        if f"{key}-axes" in settings:
            fields[key] = axes_of(settings[f"{key}-axes"], f"--{key}-axes")
    return check_convention(Convention(**fields))


def reading_of(declaration: Declaration, table: Table) -> Reading:
    """The trace's columns and convention. Raises UsageError and TraceError."""
    columns, settings = settings_of(declaration)
    how = convention_of(settings)
    check_sequence(how.euler)
    order = settings.get("quaternion", DEFAULT_ORDER)
    return Reading(table, columns_of(table, columns, order, how.euler), how)
