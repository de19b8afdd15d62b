"""The trace's file as columns of numbers: what was read, and how finely it was written."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from omegadot.harness.usage import UsageError, nearest
from omegadot.reference_impl.system import Array

MOST_SAMPLES = 200_000
LARGEST_NUMBER = 1e100  # its square is a number too; no motion holds more


class TraceError(UsageError):
    """The trace cannot be scored; the message is one sentence."""


@dataclass(frozen=True)
class Column:
    """One column. values: (n,).  open: (n,), their resolution, by the digits as written."""

    values: Array
    open: Array


class Table(Protocol):
    """What the two kinds of file have in common."""

    @property
    def file(self) -> str:
        """Its name, for errors."""
        ...

    @property
    def names(self) -> tuple[str, ...]:
        """The names of its columns."""
        ...

    def __len__(self) -> int:
        """How many samples there are."""
        ...

    def place(self, sample: int) -> str:
        """Where a sample stands in the file: "line 7" or "row 7"."""
        ...

    def column(self, name: str) -> Column:
        """One column's numbers. Raises TraceError where it holds anything else."""
        ...


def find_column(table: Table, wanted: str, role: str) -> str:
    """The column of this name, or of this number (from one, as ``#3``). Raises TraceError."""
    if wanted in table.names:
        check_alone(table, wanted)
        return wanted
    if wanted.startswith("#") and wanted[1:].isdecimal():
        number = int(wanted[1:])
        if 1 <= number <= len(table.names):
            name = table.names[number - 1]
            return name if table.names.count(name) == 1 else wanted
        raise TraceError(
            f"{table.file}: there is no column {wanted} for {role}; it has {len(table.names)}."
        )
    folded = {name.casefold(): name for name in table.names}
    if wanted.casefold() in folded:
        return folded[wanted.casefold()]
    raise TraceError(
        f"{table.file}: there is no column {wanted!r} for {role}; "
        f"{_near(wanted, table.names)} (the columns are {_listed(table.names)})."
    )


def check_alone(table: Table, name: str) -> None:
    """Raise TraceError where another column has the same name."""
    if table.names.count(name) > 1:
        raise TraceError(
            f"{table.file}: two columns have the name {name!r}; rename one, or give its number, "
            f"like #{table.names.index(name) + 1}."
        )


def _near(wanted: str, names: Sequence[str]) -> str:
    advice = nearest(wanted, names)
    return advice if advice.startswith("write ") else "give an existing one"


def _listed(names: Sequence[str], most: int = 20) -> str:
    shown = ", ".join(repr(name) for name in names[:most])
    return shown + (f" and {len(names) - most} more" if len(names) > most else "")
