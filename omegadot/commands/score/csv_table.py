"""CSV as it comes: any usual delimiter, comments, a header or none, a byte-order mark."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
import polars as pl

from omegadot.commands.score.csv_lines import (
    COMMENT,
    DECIMAL_COMMA,
    NOT_FINITE,
    NUMBER,
    cells_of,
    comment_names,
    decimal_of,
    delimiter_of,
    is_sample,
    names_of,
    raw_cells_of,
    split_lines,
    text_of,
)
from omegadot.commands.score.digits import open_of
from omegadot.commands.score.table import (
    LARGEST_NUMBER,
    MOST_SAMPLES,
    Column,
    TraceError,
    check_alone,
)
from omegadot.reference_impl.system import Array

# So many lines show the delimiter and the decimal sign.
LOOKED_AT = 50


@dataclass(frozen=True)
class CsvTable:
    """The cells of a CSV file. rows: lists of texts.  lines: the line that each row stands in."""

    file: str
    names: tuple[str, ...]
    rows: pl.Series
    lines: pl.Series
    decimal: str = "."

    def __len__(self) -> int:
        """How many samples there are."""
        return len(self.rows)

    def place(self, sample: int) -> str:
        """The line that a sample stands in."""
        return f"line {self.lines[sample]}"

    def _read(self, name: str) -> tuple[list[str], Array]:
        """One column's texts, with decimal points, and its numbers. Raises TraceError."""
        check_alone(self, name)
        place = self.names.index(name) if name in self.names else int(name[1:]) - 1
        written = self.rows.list.get(place, null_on_oob=True).fill_null("").str.strip_chars()
        texts = written.str.replace(self.decimal, ".", literal=True)
        numbers = texts.str.replace("[dD]", "e").cast(pl.Float64, strict=False)
        values = numbers.fill_null(float("nan")).to_numpy()
        well = written.str.contains(NUMBER.replace(r"\.", re.escape(self.decimal))).to_numpy()
        bad = np.flatnonzero(~(well & (np.abs(values) <= LARGEST_NUMBER)))
        if len(bad):
            more = f", and {len(bad) - 1} more" if len(bad) > 1 else ""
            line, text = self.place(int(bad[0])), str(written[int(bad[0])])
            raise TraceError(f"{self.file}: {line}: {name!r} {self._found(text)}{more}.")
        return texts.to_list(), values

    def cells(self, name: str) -> list[str]:
        """One column's texts, with decimal points. Raises TraceError where one is no number."""
        return self._read(name)[0]

    def column(self, name: str) -> Column:
        """One column's numbers. Raises TraceError."""
        texts, values = self._read(name)
        return Column(values, open_of(texts, values))

    def _found(self, text: str) -> str:
        if not text:
            return "is empty, a number was expected"
        if self.decimal == "." and DECIMAL_COMMA.match(text):
            return f"is {text[:20]!r}; write it with a decimal point"
        if self.decimal == "," and "." in text:
            return f"is {text[:20]!r}; write it with a decimal comma, as the others"
        if NOT_FINITE.match(text) or re.match(NUMBER, text.replace(self.decimal, ".")):
            return f"is {text[:20]}, a finite number of sensible size was expected"
        return f"is {text[:20]!r}, a number was expected"


def csv_table(file: str, content: bytes) -> CsvTable:
    """The table in a CSV file's bytes. Raises TraceError."""
    texts = text_of(file, content).splitlines()
    whole = pl.DataFrame({"line": range(1, len(texts) + 1), "text": texts})
    whole = whole.filter(pl.col("text").str.contains(r"\S"))
    is_comment = pl.col("text").str.contains(COMMENT)
    plain = whole.filter(~is_comment)
    if plain.is_empty():
        raise TraceError(f"{file}: holds nothing but comments; give a trace with samples.")
    looked_at = plain["text"].head(LOOKED_AT).to_list()
    delimiter = delimiter_of(looked_at)
    decimal = decimal_of(file, [cells_of(text, delimiter) for text in looked_at])
    heads: list[str] = []
    for text in plain["text"]:
        if is_sample(cells_of(text, delimiter)):
            break
        heads.append(text)
    samples = plain[len(heads) :]
    if samples.is_empty():
        raise TraceError(f"{file}: no line of numbers; it has a header at most, give samples too.")
    above = whole.filter(is_comment, pl.col("line") < samples["line"][0])["text"].to_list()
    names = _names(heads, above, samples["text"][0], delimiter)
    return CsvTable(
        file, names, _rows(file, samples, delimiter, len(names)), samples["line"], decimal
    )


def _names(heads: list[str], comments: list[str], sample: str, delimiter: str) -> tuple[str, ...]:
    """A name for every column: of the first line that has them, else of a comment, else numbers."""
    width = len(cells_of(sample, delimiter))
    # The delimiter that ends a line is that of a last, empty cell where the header has one more.
    widths = [width, len(raw_cells_of(sample, delimiter))]
    found = next(filter(None, (names_of(text, delimiter, widths) for text in heads)), [])
    found = found or comment_names(comments, delimiter, width) or [""] * width
    return tuple(name or f"#{k}" for k, name in enumerate(found, 1))


def _rows(file: str, samples: pl.DataFrame, delimiter: str, width: int) -> pl.Series:
    """The samples' cells, as they stand. Raises TraceError where a row has not so many."""
    if len(samples) > MOST_SAMPLES:
        raise TraceError(
            f"{file}: {len(samples):,} samples; give at most {MOST_SAMPLES:,}, every tenth of them "
            "for example."
        )
    rows = split_lines(samples["text"], delimiter)
    ends_empty = rows.list.last().str.strip_chars() == ""
    counts = rows.list.len().cast(pl.Int64) - ends_empty.cast(pl.Int64)
    bad = ((counts != width) & (counts != width - 1)).arg_true()
    if len(bad):
        line, count = samples["line"][int(bad[0])], counts[int(bad[0])]
        raise TraceError(
            f"{file}: line {line} has {count} columns, {width} were expected; correct or remove it."
        )
    return rows
