"""CSV as it comes: any usual delimiter, comments, a header or none, a byte-order mark."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.commands.score.csv_lines import (
    COMMENT,
    NOT_FINITE,
    NUMBER,
    cells_of,
    comment_names,
    delimiter_of,
    header_names,
    is_sample,
    text_of,
)
from omegadot.commands.score.digits import open_of
from omegadot.commands.score.table import LARGEST_NUMBER, MOST_SAMPLES, Column, TraceError

_DECIMAL_COMMA = re.compile(r"[+-]?\d+,\d+([eEdD][+-]?\d+)?$")


@dataclass(frozen=True)
class CsvTable:
    """The cells of a CSV file. lines: the number of the line that each row stands in."""

    file: str
    names: tuple[str, ...]
    rows: Sequence[Sequence[str]]
    lines: Sequence[int]

    def __len__(self) -> int:
        """How many samples there are."""
        return len(self.rows)

    def place(self, sample: int) -> str:
        """The line that a sample stands in."""
        return f"line {self.lines[sample]}"

    def cells(self, name: str) -> list[str]:
        """One column's texts. Raises TraceError where one is no finite number."""
        place = self.names.index(name)
        texts = [row[place].strip() for row in self.rows]
        bad = [k for k, text in enumerate(texts) if not _is_finite(text)]
        if bad:
            more = f", and {len(bad) - 1} more" if len(bad) > 1 else ""
            line, text = self.place(bad[0]), texts[bad[0]]
            raise TraceError(f"{self.file}: {line}: {name!r} {_found(text)}{more}.")
        return texts

    def column(self, name: str) -> Column:
        """One column's numbers. Raises TraceError."""
        texts = self.cells(name)
        values = np.array([_value(text) for text in texts])
        return Column(values, open_of(texts, values))


def _value(text: str) -> float:
    return float(text.replace("D", "e").replace("d", "e"))


def _is_finite(text: str) -> bool:
    return bool(NUMBER.match(text)) and abs(_value(text)) <= LARGEST_NUMBER


def _found(text: str) -> str:
    if not text:
        return "is empty, a number was expected"
    if NOT_FINITE.match(text) or NUMBER.match(text):
        return f"is {text[:20]}, a finite number of sensible size was expected"
    if _DECIMAL_COMMA.match(text):
        return f"is {text[:20]!r}; write it with a decimal point"
    return f"is {text[:20]!r}, a number was expected"


def csv_table(file: str, content: bytes) -> CsvTable:
    """The table in a CSV file's bytes. Raises TraceError."""
    lines = text_of(file, content).splitlines()
    numbered = [(k, line) for k, line in enumerate(lines, 1) if line.strip()]
    plain = [(k, line) for k, line in numbered if not COMMENT.match(line)]
    if not plain:
        raise TraceError(f"{file}: holds nothing but comments; give a trace with samples.")
    delimiter = delimiter_of([line for _, line in plain[:50]])
    rows = [(k, cells_of(line, delimiter)) for k, line in plain]
    first = next((i for i, (_, row) in enumerate(rows) if is_sample(row)), len(rows))
    if first == len(rows):
        raise TraceError(f"{file}: no line of numbers; it has a header at most, give samples too.")
    width = len(rows[first][1])
    names = header_names(file, rows[:first], width)
    if not names:
        names = comment_names(numbered, rows[first][0], delimiter, width)
    return _checked(file, names, rows[first:], width)


def _checked(
    file: str, names: tuple[str, ...], rows: list[tuple[int, list[str]]], width: int
) -> CsvTable:
    for line, row in rows:
        if len(row) != width:
            # The delimiter dropped at the end may have been that of a last, empty cell.
            if len(row) == width - 1:
                row.append("")
                continue
            raise TraceError(
                f"{file}: line {line} has {len(row)} columns, {width} were expected; correct or "
                "remove it."
            )
    if len(rows) > MOST_SAMPLES:
        raise TraceError(
            f"{file}: {len(rows):,} samples; give at most {MOST_SAMPLES:,}, every tenth of them "
            "for example."
        )
    return CsvTable(file, names, [row for _, row in rows], [line for line, _ in rows])
