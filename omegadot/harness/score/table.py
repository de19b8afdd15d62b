"""The trace's file as columns of numbers: what was read, and how finely it was written."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from omegadot.harness.usage import nearest
from omegadot.harness.usage_error import UsageError
from omegadot.reference_impl.system import Array

LARGEST_FILE = 500_000_000  # bytes
MOST_SAMPLES = 200_000
LARGEST_NUMBER = 1e100  # its square is a number too; no motion holds more
PARQUET_MAGIC = b"PAR1"


class TraceError(UsageError):
    """The trace cannot be scored; the message is one sentence."""


@dataclass(frozen=True)
class Column:
    """One column. values: (n,).  open: (n,), what the digits it is written in leave open."""

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
        return wanted
    if wanted.startswith("#") and wanted[1:].isdecimal():
        number = int(wanted[1:])
        if 1 <= number <= len(table.names):
            return table.names[number - 1]
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


def _near(wanted: str, names: Sequence[str]) -> str:
    advice = nearest(wanted, names)
    return advice if advice.startswith("write ") else "give one that is there"


def _listed(names: Sequence[str], most: int = 20) -> str:
    shown = ", ".join(repr(name) for name in names[:most])
    return shown + (f" and {len(names) - most} more" if len(names) > most else "")


def read_table(path: Path) -> Table:
    """A CSV or Parquet file, told apart by what it begins with. Raises TraceError."""
    from omegadot.harness.score.csv_table import csv_table
    from omegadot.harness.score.parquet_table import parquet_table

    content = _read(path)
    if content.startswith(PARQUET_MAGIC) or path.suffix.lower() in (".parquet", ".pq"):
        return parquet_table(str(path), content)
    return csv_table(str(path), content)


def _read(path: Path) -> bytes:
    try:
        if path.is_dir():
            raise TraceError(f"{path}: is a directory; give a CSV or Parquet file.")
        if not path.exists():
            raise TraceError(f"{path}: no such file; give a CSV or Parquet file.")
        if not path.is_file():
            raise TraceError(f"{path}: is not a regular file; give a CSV or Parquet file.")
        size = path.stat().st_size
        if size > LARGEST_FILE:
            raise TraceError(
                f"{path}: holds {size:,} bytes; give a trace of at most {LARGEST_FILE:,}."
            )
        content = path.read_bytes()
    except OSError as error:
        raise TraceError(f"{path}: not readable ({error.strerror or error}).") from error
    except TraceError:
        raise
    except ValueError as error:  # a NUL in the name
        raise TraceError(f"{str(path)!r}: not a path.") from error
    if not content.strip():
        raise TraceError(f"{path}: is empty; give a trace with at least two samples.")
    return content
