"""A table reads back to the last bit, and its lines keep their numbers, however it is written."""

from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from omegadot.commands.score.columns import columns_of
from omegadot.commands.score.csv_table import csv_table
from omegadot.commands.score.table import TraceError, find_column

NUMBERS = st.floats(-1e99, 1e99, allow_subnormal=True)
ASIDE = ["", "  ", "# a, b; c", "% 1 2 3"]


@dataclass(frozen=True)
class Dialect:
    delimiter: str
    decimal: str
    form: str
    exponent: str
    quoted: bool
    header: str
    ends: str
    last: bool

    def number(self, value: float) -> str:
        text = (self.form % value).replace("e", self.exponent).replace(".", self.decimal)
        return f'"{text}"' if self.quoted else text

    def line(self, cells: list[str]) -> str:
        return self.delimiter.join(cells) + (self.delimiter if self.last else "")


@st.composite
def dialects(draw: st.DrawFn) -> Dialect:
    delimiter = draw(st.sampled_from([",", ";", "\t", "|", " ", "   ", " \t"]))
    single = len(delimiter) == 1 and delimiter != " "
    return Dialect(
        delimiter,
        draw(st.sampled_from([".", ","])) if delimiter in ";\t|" else ".",
        draw(st.sampled_from(["%.17g", "%+.17g", "%.16e", "%.20e"])),
        draw(st.sampled_from("eEdD")),
        draw(st.booleans()) and single,
        draw(st.sampled_from(["names", "comment", "none"])),
        draw(st.sampled_from(["\n", "\r\n", "\r"])),
        draw(st.booleans()) and single,
    )


TABLES = st.integers(2, 6).flatmap(
    lambda width: st.lists(st.lists(NUMBERS, min_size=width, max_size=width), min_size=1)
)


@given(TABLES, dialects(), st.lists(st.sampled_from(ASIDE)), st.randoms(use_true_random=False))
def test_every_dialect_is_read_to_the_last_bit(rows, dialect, asides, random):
    width = len(rows[0])
    names = [f"name{k}" for k in range(width)]
    samples = [dialect.line([dialect.number(value) for value in row]) for row in rows]
    placed = sorted(random.sample(range(len(samples) + len(asides)), len(asides)))
    lines = list(samples)
    for place, aside in zip(placed, asides, strict=True):
        # the last comment before the values may hold their names
        lines.insert(max(place, 1) if dialect.header == "comment" else place, aside)
    heads = {"names": [dialect.line(names)], "comment": ["# " + dialect.line(names)], "none": []}
    lines = heads[dialect.header] + lines
    table = csv_table(
        "trace", ("\ufeff" * random.randint(0, 1) + dialect.ends.join(lines)).encode()
    )
    assert table.names == tuple(f"#{k + 1}" for k in range(width) if dialect.header == "none") or (
        table.names == tuple(names)
    )
    read = np.stack([table.column(name).values for name in table.names], axis=-1)
    assert np.array_equal(read, np.array(rows))
    assert np.array_equal(np.signbit(read), np.signbit(np.array(rows)))
    own = [k for k, line in enumerate(lines, 1) if line in samples]
    assert [table.place(k) for k in range(len(table))] == [f"line {k}" for k in own]


@pytest.mark.parametrize("cell", ["1_0", "0x1p3", "1e", "--1", "1.2.3", "१", "1 2", "+", ".", "e5"])
def test_what_only_some_readers_take_for_a_number_is_none(cell):
    table = csv_table("trace", f"t,wx\n0,1\n1,{cell}\n".encode())
    with pytest.raises(TraceError, match="line 3: 'wx' is"):
        table.column("wx")


def test_a_last_column_that_fills_later_is_one():
    table = csv_table("trace", b"time,wx,gps\n0.0,1,\n1.0,2,\n2.0,3,47.1\n3.0,4\n")
    assert table.names == ("time", "wx", "gps")
    assert list(table.column("wx").values) == [1, 2, 3, 4]
    with pytest.raises(TraceError, match="line 2: 'gps' is empty, a number was expected, and 2"):
        table.column("gps")


@pytest.mark.parametrize("line", ["3,4", "3,4,5,6,7", "3,4,5,6,", '3,"4",5,6,7'])
def test_a_line_of_another_length_is_named(line):
    text = f"# one\na,b,c,d\n\n0,1,2,3\n{line}\n"
    if line == "3,4,5,6,":
        assert len(csv_table("trace", text.encode())) == 2
        return
    with pytest.raises(TraceError, match=f"line 5 has {line.count(',') + 1} columns, 4 were"):
        csv_table("trace", text.encode())


def test_two_columns_of_one_name_matter_where_one_is_used():
    table = csv_table("trace", b"time,a,vz,vz\n0,1,2,3\n1,4,5,6\n")
    assert columns_of(table, [("p", ["a", "a", "a"])], "wxyz", "ZYX").keys() == {
        *("t", "px", "py", "pz")
    }
    assert list(table.column("a").values) == [1, 4]
    assert list(table.column(find_column(table, "#4", "wz")).values) == [3, 6]
    with pytest.raises(TraceError, match=r"two columns have the name 'vz'; .* like #3"):
        table.column(find_column(table, "vz", "wz"))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("t;wx\n0;1,5\n1;2.5\n", "line 2: 'wx' is '1,5'; write it with a decimal point"),
        ("t;wx\n" + "0,5;1,5\n" * 60 + "1,5;2.5\n", "line 62: 'wx' is '2.5'; write it with a dec"),
        ("t;wx\n1,000;1,500\n2,000;3,000\n", "'1,000' may be 1.000 or 1000; write it with a"),
    ],
)
def test_decimal_signs_that_disagree_are_refused(text, message):
    with pytest.raises(TraceError, match=message):
        csv_table("trace", text.encode()).column("wx")


def test_names_between_blanks_may_have_units_behind_them():
    text = (
        "# Sample rate: 100 Hz\n# Started at: 2025-01-01 12:00\n#time   wx (deg/s)   wy (deg/s)\n"
    )
    for head in (text, text.replace("#time", "time")):
        table = csv_table("trace", f"{head}0.0   1.0   2.0\n1.0   3.0   4.0\n".encode())
        assert table.names == ("time", "wx (deg/s)", "wy (deg/s)")
