"""Lines of a CSV file: their text, their delimiter, their cells, the names above them."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence

from omegadot.commands.score.table import TraceError

DELIMITERS = ",;\t|"
COMMENT = re.compile(r"\s*(#|%|//|!)")
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?$")
NOT_FINITE = re.compile(r"[+-]?(nan|inf|infinity|1\.#\w+|na|null|none)$", re.IGNORECASE)


def text_of(file: str, content: bytes) -> str:
    """The file's text. Raises TraceError where it is no UTF-8 text."""
    if b"\0" in content:
        raise TraceError(f"{file}: neither CSV nor Parquet (binary, or text that is not UTF-8).")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise TraceError(
            f"{file}: not UTF-8 text (byte 0x{content[error.start]:02x} in line {line}); "
            "save it in UTF-8."
        ) from None


def delimiter_of(lines: Sequence[str]) -> str:
    """The delimiter that splits most lines into equally many, at least two; else blanks."""
    best, most = "", (0, 0)
    for delimiter in (*DELIMITERS, ""):
        counts = [len(cells_of(line, delimiter)) for line in lines]
        common = max(set(counts), key=counts.count)
        # A decimal comma splits too, but then less regularly, or a semicolon splits as well.
        found = (counts.count(common), -("\t;|,".find(delimiter) if delimiter else 9))
        if common > 1 and found > most:
            best, most = delimiter, found
    return best


def cells_of(line: str, delimiter: str) -> list[str]:
    """The cells of a line, without the blanks around them."""
    if not delimiter:
        return line.split()
    row = [cell.strip() for cell in next(csv.reader([line], delimiter=delimiter), [])]
    # A delimiter at the end of a line makes no column.
    return row[:-1] if len(row) > 1 and not row[-1] else row


def is_sample(row: Sequence[str]) -> bool:
    """A row that is of numbers: more than half of it, so that one bad cell does not hide it."""
    numbers = sum(bool(NUMBER.match(c) or NOT_FINITE.match(c)) for c in row)
    return 2 * numbers > len(row)


def header_names(file: str, heads: Sequence[tuple[int, list[str]]], width: int) -> tuple[str, ...]:
    """The header's names: of the first line that has one for every column."""
    for _, row in heads:
        if len(row) == width:
            return _unique(file, row)
    return ()


def _unique(file: str, row: Sequence[str]) -> tuple[str, ...]:
    twice = [name for k, name in enumerate(row) if name and name in row[:k]]
    if twice:
        raise TraceError(f"{file}: two columns are called {twice[0]!r}; rename one.")
    return tuple(name or f"#{k}" for k, name in enumerate(row, 1))


def comment_names(
    numbered: Sequence[tuple[int, str]], first: int, delimiter: str, width: int
) -> tuple[str, ...]:
    """Names in the last comment before the samples, as NumPy writes them; else #1, #2, ..."""
    for line, text in reversed(numbered):
        found = COMMENT.match(text)
        if line < first and found:
            row = cells_of(text[found.end() :].strip(), delimiter)
            if len(row) == width and len(set(row)) == width and not is_sample(row):
                return tuple(row)
    return tuple(f"#{k}" for k in range(1, width + 1))
