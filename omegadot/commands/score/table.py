"""The trace's file as columns of numbers: what was read, and how finely it was written."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import polars as pl
from numpy.typing import NDArray

from omegadot.commands.score.dates import decimal_seconds
from omegadot.commands.score.digits import DECIMAL_COMMA, NOT_FINITE, NUMBER, open_of, open_time
from omegadot.gates.bounds.scales import EPS
from omegadot.harness.usage import UsageError, nearest
from omegadot.reference_impl.system import Array

_UNIT = re.compile(r"\s*(\([^()]*\)|\[[^\[\]]*\])\s*$")
MOST_SAMPLES = 200_000
LARGEST_NUMBER = 1e100  # its square is a number too; no motion holds more


class TraceError(UsageError):
    """The trace cannot be scored; the message is one sentence."""


@dataclass(frozen=True)
class Column:
    """One column. values: (n,).  texts: as written; None of binary numbers, of relative `eps`."""

    values: Array
    texts: Sequence[str] | None = None
    eps: float = EPS

    @property
    def open(self) -> Array:
        """(n,), the resolution by the digits as written."""
        if self.texts is None:
            return 0.5 * self.eps * np.abs(self.values)
        return open_of(self.texts, self.values)

    @property
    def open_time(self) -> Array:
        """(n,), the same of time stamps."""
        return self.open if self.texts is None else open_time(self.texts, self.values)


@dataclass(frozen=True)
class Table:
    """A trace's file. cells: by column, the texts of a CSV file, or the values of a Parquet file.

    lines: those that a CSV file's samples stand in, None of a Parquet file.  decimal: its sign.
    rows: which of the file's samples these are; None of all.
    """

    file: str
    names: tuple[str, ...]
    cells: list[pl.Series]
    lines: pl.Series | None = None
    decimal: str = "."
    rows: NDArray[np.intp] | None = None

    def __len__(self) -> int:
        """How many samples there are."""
        return len(self.cells[0])

    @property
    def numbers(self) -> NDArray[np.intp]:
        """(n,): the samples' numbers in the file, from zero."""
        return np.arange(len(self)) if self.rows is None else self.rows

    def part(self, inside: NDArray[np.bool_]) -> Table:
        """The samples for which `inside`, (n,), is true."""
        rows = np.flatnonzero(inside)
        lines = None if self.lines is None else self.lines.gather(rows)
        cells = [cell.gather(rows) for cell in self.cells]
        return replace(self, cells=cells, lines=lines, rows=self.numbers[rows])

    def place(self, sample: int) -> str:
        """Where a sample stands in the file: "line 7" or "row 7"."""
        if self.lines is None:
            return f"row {self.numbers[sample] + 1}"
        return f"line {self.lines[sample]}"

    def _cells(self, name: str) -> pl.Series:
        check_alone(self, name)
        return self.cells[self.names.index(name) if name in self.names else int(name[1:]) - 1]

    def times(self, name: str) -> tuple[Column, bool]:
        """A column of time stamps, and whether they are dates. Raises TraceError.

        Dates are read as s since 1970, times of day as s since midnight.
        """
        cells = self._cells(name)
        texts = decimal_seconds(cells)
        if texts is None:
            column = self.column(name)
            if cells.dtype.is_integer():  # an epoch in ns has more digits than a double
                column = replace(column, texts=[str(cell) for cell in cells])
            return column, False
        well = np.array([bool(text) for text in texts])
        self._check(name, cells, well)
        return Column(np.array([float(text) for text in texts]), texts), True

    def column(self, name: str) -> Column:
        """One column's numbers. Raises TraceError where it holds anything else."""
        cells = self._cells(name)
        if self.lines is None:
            if not cells.dtype.is_numeric():
                raise TraceError(f"{self.file}: {name!r} holds {cells.dtype}, not numbers.")
            eps = float(np.finfo(np.float32).eps) if cells.dtype == pl.Float32 else EPS
            values = cells.cast(pl.Float64).fill_null(float("nan")).to_numpy()
            self._check(name, cells, np.abs(values) <= LARGEST_NUMBER)
            return Column(values, eps=eps)
        cells = cells.fill_null("").str.strip_chars()
        texts = cells.str.replace(self.decimal, ".", literal=True)
        numbers = texts.str.replace("[dD]", "e").cast(pl.Float64, strict=False)
        values = numbers.fill_null(float("nan")).to_numpy()
        well = cells.str.contains(NUMBER.replace(r"\.", re.escape(self.decimal))).to_numpy()
        self._check(name, cells, well & (np.abs(values) <= LARGEST_NUMBER))
        return Column(values, texts.to_list())

    def _check(self, name: str, cells: pl.Series, well: NDArray[np.bool_]) -> None:
        bad = np.flatnonzero(~well)
        if len(bad):
            more = f", and {len(bad) - 1} more" if len(bad) > 1 else ""
            place, fault = self.place(int(bad[0])), self._fault(cells[int(bad[0])])
            raise TraceError(f"{self.file}: {place}: {name!r} {fault}{more}.")

    def _fault(self, cell: object) -> str:
        text = "" if cell is None else str(cell)
        if self.lines is None:
            found = text or "empty"
            return f"is {found}, a finite number of sensible size was expected"
        if not text:
            return "is empty, a number was expected"
        if self.decimal == "." and DECIMAL_COMMA.match(text):
            return f"is {text[:20]!r}; write it with a decimal point"
        if self.decimal == "," and "." in text:
            return f"is {text[:20]!r}; write it with a decimal comma, as the others"
        if NOT_FINITE.match(text) or re.match(NUMBER, text.replace(self.decimal, ".")):
            return f"is {text[:20]}, a finite number of sensible size was expected"
        return f"is {text[:20]!r}, a number was expected"


def bare(name: str) -> str:
    """A column's name in small letters and without its unit: "wx" of ``wX (deg/s)``."""
    return _UNIT.sub("", name).strip().casefold()


def unit_text(name: str) -> str:
    """What stands in brackets at the end of a column's name: "deg/s" of ``wX (deg/s)``."""
    found = _UNIT.search(name)
    return found[1][1:-1].strip() if found else ""


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
    for known in (str.casefold, bare):
        alike = [name for name in table.names if known(name) == wanted.casefold()]
        if len(alike) == 1 or len(set(alike)) == 1:
            check_alone(table, alike[0])
            return alike[0]
    advice, shown = nearest(wanted, table.names), ", ".join(map(repr, table.names[:20]))
    advice = advice if advice.startswith("write ") else "give an existing one"
    more = f" and {len(table.names) - 20} more" if len(table.names) > 20 else ""
    raise TraceError(
        f"{table.file}: there is no column {wanted!r} for {role}; {advice} "
        f"(the columns are {shown}{more})."
    )


def check_alone(table: Table, name: str) -> None:
    """Raise TraceError where another column has the same name."""
    if table.names.count(name) > 1:
        raise TraceError(
            f"{table.file}: two columns have the name {name!r}; rename one, or give its number, "
            f"like #{table.names.index(name) + 1}."
        )
