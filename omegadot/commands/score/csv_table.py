"""CSV as it comes: any usual delimiter, comments, a header or none, a byte-order mark."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Sequence
from itertools import chain, takewhile

import polars as pl

from omegadot.commands.score.dates import DATE
from omegadot.commands.score.digits import DECIMAL_COMMA, NOT_FINITE, NUMBER
from omegadot.commands.score.table import MOST_SAMPLES, Table, TraceError

DELIMITERS = ",;\t|"
COMMENT = r"^\s*(#|%|//|!)"
_PREFIX = re.compile(r"\s*(columns|fields|names|header)\s*[:=]\s*", re.IGNORECASE)
_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}(,\d{3})+$")
# So many lines show the delimiter and the decimal sign.
LOOKED_AT = 50
LONGEST_LINE = csv.field_size_limit()  # a longer cell is none of a table's


def csv_table(file: str, content: bytes) -> Table:
    """The table in a CSV file's bytes. Raises TraceError."""
    texts = text_of(file, content).splitlines()
    long = next((k for k, text in enumerate(texts, 1) if len(text) > LONGEST_LINE), None)
    if long is not None:
        raise TraceError(
            f"{file}: line {long} has {len(texts[long - 1]):,} characters; give a table of at most "
            f"{LONGEST_LINE:,} a line."
        )
    lines = {"line": range(1, len(texts) + 1), "text": texts}
    whole = pl.DataFrame(lines, schema_overrides={"text": pl.String})  # where there are none too
    whole = whole.filter(pl.col("text").str.contains(r"\S"))
    is_comment = pl.col("text").str.contains(COMMENT)
    plain = whole.filter(~is_comment)
    if plain.is_empty():
        raise TraceError(f"{file}: holds nothing but comments; give a trace with samples.")
    looked_at = plain["text"].head(LOOKED_AT).to_list()
    delimiter = delimiter_of(looked_at)
    decimal = decimal_of(file, [cells_of(text, delimiter) for text in looked_at])
    heads = list(takewhile(lambda text: not is_sample(cells_of(text, delimiter)), plain["text"]))
    samples = plain[len(heads) :]
    if samples.is_empty():
        raise TraceError(f"{file}: no line of numbers; it has a header at most, give samples too.")
    above = whole.filter(is_comment, pl.col("line") < samples["line"][0])["text"].to_list()
    rows = _rows(file, samples, delimiter)
    names = _names(heads, above, _widths(rows), delimiter)
    _check_widths(file, samples["line"], rows, len(names), delimiter)
    cells = [rows.list.get(place, null_on_oob=True) for place in range(len(names))]
    return Table(file, names, cells, samples["line"], decimal)


def _names(
    heads: list[str], comments: list[str], widths: list[int], delimiter: str
) -> tuple[str, ...]:
    """A name for every column: of the first line that has them, else of a comment, else numbers.

    Of the comments it is the last one that has some, as NumPy writes them.
    """
    rows = [names_of(text, delimiter, widths) for text in heads]
    for text in reversed(comments):
        row = names_of(re.sub(COMMENT, "", text).strip(), delimiter, widths)
        rows += [row] if len(set(row)) == len(row) and not is_sample(row) else []
    found = next(filter(None, rows), [""] * widths[-1])
    return tuple(name or f"#{k}" for k, name in enumerate(found, 1))


def _rows(file: str, samples: pl.DataFrame, delimiter: str) -> pl.Series:
    """The samples' cells, as they stand. Raises TraceError where there are too many samples."""
    if len(samples) > MOST_SAMPLES:
        raise TraceError(
            f"{file}: {len(samples):,} samples; give at most {MOST_SAMPLES:,}, every tenth of them "
            "for example."
        )
    return split_lines(samples["text"], delimiter)


def _counts(rows: pl.Series) -> tuple[pl.Series, pl.Series]:
    """How many cells each row has, and how many without an empty one at its end."""
    ends_empty = rows.list.last().str.strip_chars() == ""
    counts = rows.list.len().cast(pl.Int64)
    return counts, counts - ends_empty.cast(pl.Int64)


def _widths(rows: pl.Series) -> list[int]:
    """How many columns there may be, the likeliest last.

    The delimiter that ends a line is that of a last, empty cell where a header, or any row, has one
    more.
    """
    raw, counts = _counts(rows)
    most = int(counts.max())  # type: ignore[arg-type]
    return [int(counts[0]), int(raw[0]), most]


def _check_widths(file: str, lines: pl.Series, rows: pl.Series, width: int, delimiter: str) -> None:
    """Raise TraceError where a row has not so many cells; the last may be empty.

    Between blanks an empty cell cannot be seen, so that a row may end early there.
    """
    raw, counts = _counts(rows)
    bad = (raw != width) & (counts != width) & (counts != width - 1)
    bad = (bad if delimiter else counts > width).arg_true()
    if len(bad):
        line, count = lines[int(bad[0])], counts[int(bad[0])]
        raise TraceError(
            f"{file}: line {line} has {count} columns, {width} were expected; correct or remove it."
        )


_UTF16 = (b"\xff\xfe", b"\xfe\xff")  # how such a text begins


def text_of(file: str, content: bytes) -> str:
    """The file's text. Raises TraceError where it is no UTF-8 text."""
    if content.startswith(_UTF16):
        raise TraceError(f"{file}: UTF-16 text; save it in UTF-8.")
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


def raw_cells_of(line: str, delimiter: str) -> list[str]:
    """The cells of a line as they stand; with no delimiter, what stands between blanks."""
    return next(csv.reader([line], delimiter=delimiter), []) if delimiter else line.split()


def cells_of(line: str, delimiter: str) -> list[str]:
    """The cells of a line, without the blanks around them."""
    row = [cell.strip() for cell in raw_cells_of(line, delimiter)]
    # A delimiter at the end of a line makes no column.
    return row[:-1] if len(row) > 1 and not row[-1] else row


def split_lines(lines: pl.Series, delimiter: str) -> pl.Series:
    """`raw_cells_of` every line, all at once: lists of texts."""
    if not delimiter:
        return lines.str.strip_chars().str.replace_all(r"\s+", " ").str.split(" ")
    if lines.str.contains('"', literal=True).any():  # a delimiter may stand within quotes
        cells = [raw_cells_of(line, delimiter) for line in lines]
        return pl.Series(cells, dtype=pl.List(pl.String))
    return lines.str.split(delimiter)


def decimal_of(file: str, rows: Iterable[Sequence[str]]) -> str:
    """The decimal sign: a comma where numbers have one and none has a point.

    Raises TraceError where it may as well group thousands.
    """
    cells = list(chain.from_iterable(rows))
    commas = [cell for cell in cells if DECIMAL_COMMA.match(cell)]
    if not commas or any("." in cell and re.match(NUMBER, cell) for cell in cells):
        return "."
    if all(_THOUSANDS.match(cell) for cell in commas):
        raise TraceError(
            f"{file}: {commas[0]!r} may be {commas[0].replace(',', '.')} or "
            f"{commas[0].replace(',', '')}; write it with a decimal point, or without a comma."
        )
    return ","


def is_sample(row: Sequence[str]) -> bool:
    """A row that is of numbers: more than half of it, so that one bad cell does not hide it.

    Empty cells are neither; dates and times of day are numbers.
    """
    filled = [cell for cell in row if cell]
    known = (NUMBER, DECIMAL_COMMA, NOT_FINITE, DATE)
    return 2 * sum(any(re.match(p, c) for p in known) for c in filled) > len(filled)


def names_of(line: str, delimiter: str, widths: Sequence[int]) -> list[str]:
    """The names that a line gives to so many columns, one of the numbers given; else none.

    Between blanks, a name may have a unit behind a single one: ``wx (deg/s)   wy (deg/s)``. A
    comment may name its columns so, or between commas, whatever separates the samples, and behind
    a term such as ``columns:``.
    """
    line = _PREFIX.sub("", line)
    rows = [cells_of(line, other) for other in ",;" if not delimiter and other in line]
    rows += [cells_of(line, delimiter), [cell.strip() for cell in re.split(r"\s{2,}|\t", line)]]
    return next((row for row in rows if len(row) in widths), [])
