"""A fault of a trace or an option is one sentence, exit code 2, and nothing is written."""

import numpy as np
import polars as pl
import pytest
from score_line import BRICK, MAPPED, run_score, tumble, write_brick

from omegadot.commands.score.csv_table import csv_table
from omegadot.commands.score.digits import digits_of, open_of, open_time

TIMES = 0.5 * np.arange(11)


def lines(tmp_path):
    path = write_brick(tmp_path / "trace.csv", TIMES, tumble(TIMES))
    return path, path.read_text().splitlines()


def refused(tmp_path, capsys, trace, *arguments):
    """The sentence; nothing may have been written."""
    out = tmp_path / "out"
    result = run_score(capsys, trace, *(arguments or MAPPED), "--out", out)
    assert result.code == 2, result.out
    assert not out.exists()
    assert not list(tmp_path.glob(".out*"))
    assert result.err.count("\n") == 1
    assert result.out == ""
    return result.err


def edited(line, cell, text):
    def edit(rows):
        cells = rows[line].split(",")
        cells[cell] = text
        return [*rows[:line], ",".join(cells), *rows[line + 1 :]]

    return edit


@pytest.mark.parametrize(
    ("edit", "message"),
    [
        (edited(4, 2, "nan"), "line 5: 'q' is nan"),
        (edited(4, 2, "-inf"), "line 5: 'q' is -inf"),
        (edited(4, 2, "1e999"), "line 5: 'q' is 1e999"),
        (edited(4, 2, ""), "line 5: 'q' is empty"),
        (edited(4, 2, "fast"), "line 5: 'q' is 'fast'"),
        (edited(4, 0, "0.75"), "line 5: the time goes back from 1 to 0.75"),
        (edited(4, 0, "1.0"), "line 4 and line 5: the time 1 is repeated"),
        (lambda rows: [rows[0], *rows[:0:-1]], "line 3: the time goes back"),
        (lambda rows: [*rows[:-1], "5.0,1.0,2"], "line 12 has 3 columns, 7 were expected"),
        (lambda rows: rows[:1], "no line of numbers"),
        (lambda rows: rows[:2], "has one sample only"),
        (lambda rows: ["# a comment"], "nothing but comments"),
        (lambda rows: [rows[0].replace("yaw", "p"), *rows[1:]], "two columns have the name 'p'"),
        (lambda rows: [rows[0].replace("q", "qq"), *rows[1:]], "no column 'q' for wy; write qq"),
        (lambda rows: [rows[0].replace("pitch", "pich"), *rows[1:]], "no column is e2"),
        (lambda rows: [rows[0].replace("time", "when"), *rows[1:]], "no column is the time"),
        (lambda rows: [r.replace(".", ",").replace(",", ";", 0) for r in rows], "columns"),
    ],
)
def test_bad_rows_are_named(tmp_path, capsys, edit, message):
    path, rows = lines(tmp_path)
    path.write_text("\n".join(edit(rows)) + "\n")
    assert message in refused(tmp_path, capsys, path)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "is empty"),
        (b" \n\n", "is empty"),
        (b"\x89PNG\r\n\x1a\n\0\0\0", "neither CSV nor Parquet"),
        ("t,wx\n0,1\n".encode("utf-16"), "UTF-16 text; save it in UTF-8"),
        (b"t,wx,wy,wz\n0,1,\xff,3\n", "not UTF-8 text (byte 0xff in line 2)"),
        (b"PAR1 and no more", "not a readable Parquet file"),
        (b"hello world\nthis is no table\n", "no line of numbers"),
    ],
)
def test_what_is_no_table_is_refused(tmp_path, capsys, content, message):
    path = tmp_path / "trace.csv"
    path.write_bytes(content)
    assert message in refused(tmp_path, capsys, path)


def test_a_truncated_parquet_and_one_of_texts(tmp_path, capsys):
    path = tmp_path / "trace.parquet"
    frame = pl.DataFrame({"t": TIMES, "wx": TIMES, "wy": TIMES, "wz": ["a"] * len(TIMES)})
    frame.write_parquet(path)
    arguments = ("--scenario", BRICK)
    assert "'wz' holds String" in refused(tmp_path, capsys, path, *arguments)
    path.write_bytes(path.read_bytes()[:-20])
    assert "truncated or damaged" in refused(tmp_path, capsys, path, *arguments)
    gap = pl.DataFrame({"t": [0.0, 1.0], "wx": [0.1, None], "wy": [0.1, 0.2], "wz": [0.0, 0.0]})
    gap.write_parquet(path)
    assert "row 2: 'wx' is empty" in refused(tmp_path, capsys, path, *arguments)


def test_paths_that_are_no_files(tmp_path, capsys):
    assert "is a directory" in refused(tmp_path, capsys, tmp_path)
    assert "no such file" in refused(tmp_path, capsys, tmp_path / "none.csv")
    assert "not a regular file" in refused(tmp_path, capsys, "/dev/null")


W = ("--scenario", BRICK, "--column", "w=p,q,r")


def test_one_component_in_another_unit_is_refused(tmp_path, capsys):
    """Caught: an error of 98 rad/s that is measured and not judged."""
    path, rows = lines(tmp_path)
    names = rows[0].split(",")
    k = names.index("r")
    scaled = [rows[0]]
    for row in rows[1:]:
        cells = row.split(",")
        cells[k] = repr(float(cells[k]) * np.pi / 180)
        scaled.append(",".join(cells))
    path.write_text("\n".join(scaled) + "\n")
    message = refused(tmp_path, capsys, path)
    assert "column 'r' is 0.0175 times what deg/s would give here, and looks like rad/s" in message


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((*W, "--angle-unit", "deg"), "looks like deg/s; give --rate-unit deg/s"),
        ((*W, "--rate-unit", "deg/s"), "looks like deg; give --angle-unit deg"),
        ((*W, "--rate-unit", "deg/sec"), "no unit of an angular velocity; write deg/s"),
        ((*MAPPED, "--time-unit", "h"), "looks like s"),
        ((*MAPPED, "--time-offset", "1"), "starts 1 s before the scenario does"),
        ((*MAPPED, "--omega-frame", "bdy"), "write body"),
        ((*MAPPED, "--euler", "ZZX"), "not a sequence of three axes"),
        ((*MAPPED, "--world-axes", "x,y,-z"), "no rotation"),
        ((*MAPPED, "--world-axes", "x,y"), "neither three axes nor four numbers"),
        ((*MAPPED, "--world-axes", "1,1,0,0"), "not of unit length"),
        ((*MAPPED, "--column", "wx=p"), "wx is given twice"),
        ((*MAPPED, "--column", "omega=p"), "no such role"),
        ((*MAPPED, "--column", "p=p"), "3 columns were expected"),
        ((*MAPPED, "--column", "p"), "write ROLE=NAME"),
        ((*MAPPED, "--attitude", "0.1"), "'0.1' has no unit; write it as"),
        ((*MAPPED, "--attitude", "-1deg"), "not a positive, finite quantity"),
        ((*MAPPED, "--position", "1mm"), "not given: the trace lacks the position"),
        ((*MAPPED, "--integrator-scheme", "rk4-quaternion"), "give --timestep"),
        ((*MAPPED, "--integrator-scheme", "rk4"), "there is no such scheme"),
        ((*MAPPED, "--timestep", "0.3"), "stands at no whole number of steps"),
        ((*MAPPED, "--timestep", "-1"), "not a positive number"),
        ((*MAPPED, "--name", ""), "--name is empty"),
        ((*MAPPED, "--name", "exact"), "an engine has this name"),
        ((*MAPPED, "--name", "mujoco"), "an engine has this name"),
        ((*MAPPED, "--name", "a\x1b[31m"), "a name of printable characters"),
        (
            (*MAPPED, "--with", "chrono"),
            "--with chrono: no such engine; choose ammo, basilisk",
        ),
        (("--scenario", "nesc-checkcase-3"), "nesc-checkcase-2"),
        (("--scenario", BRICK, "--column", "q=p,q,r,yaw"), "|q| is"),
        ((*MAPPED, "--map", "none.toml"), "--map none.toml is missing"),
        ((*MAPPED, "--map", "/dev/zero"), "--map /dev/zero is not a regular file"),
    ],
)
def test_wrong_options_are_refused(tmp_path, capsys, arguments, message):
    path, _ = lines(tmp_path)
    assert message in refused(tmp_path, capsys, path, *arguments)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("angle-unit = 3", "angle-unit is 3; give a text"),
        ("angle_unit = 'deg'", "write angle-unit"),
        ("columns = 3", "columns must be a table"),
        ("[columns]\nw = [1, 2]", "give a column's name"),
        ("a = ", "not valid TOML"),
        ("a=" + 5000 * "[" + 5000 * "]", "brackets nested too deep"),
        ("#" * 1_000_001, "give one of at most 1,000,000 bytes"),
    ],
)
def test_a_wrong_map_is_refused(tmp_path, capsys, text, message):
    path, _ = lines(tmp_path)
    mapped = tmp_path / "map.toml"
    mapped.write_text(text)
    assert message in refused(tmp_path, capsys, path, "--scenario", BRICK, "--map", mapped)


def test_a_line_without_end_is_refused(tmp_path, capsys):
    path, _ = lines(tmp_path)
    path.write_text(path.read_text() + "1," + "9" * 200_000 + ",3,4,5,6,7\n")
    assert "has 200,012 characters" in refused(tmp_path, capsys, path, *MAPPED)


def test_a_folder_of_something_else_is_left_alone(tmp_path, capsys):
    path, _ = lines(tmp_path)
    out = tmp_path / "out"
    out.mkdir()
    (out / "thesis.tex").write_text("years of work")
    result = run_score(capsys, path, *MAPPED, "--out", out)
    assert result.code == 2
    assert [entry.name for entry in out.iterdir()] == ["thesis.tex"]


@pytest.mark.parametrize(
    "text",
    [
        "t,wx,wy\n0,1,2\n1,3,4\n",
        "\ufefft;wx;wy\r\n0;1;2\r\n1;3;4\r\n",
        "# made by something\nt\twx\twy\n0\t1\t2\n1\t3\t4\n",
        "% 1 2 3\n t   wx  wy\n 0  1.0  2\n 1  3.D0  4\n",
        "# t wx wy\n0 1 2\n1 3 4\n",
        "t,wx,wy,\n0,1,2,\n1,3,4,\n",
        '"t","wx","wy"\n(s),(deg/s),(deg/s)\n0,1,2\n\n1,3,4\n',
    ],
)
def test_tables_of_every_make_are_read_alike(text):
    table = csv_table("trace", text.encode())
    assert table.names == ("t", "wx", "wy")
    assert [list(table.column(n).values) for n in table.names] == [[0, 1], [1, 3], [2, 4]]


def test_columns_without_names_have_numbers():
    assert csv_table("trace", b"0 1 2\n1 3 4\n").names == ("#1", "#2", "#3")


@pytest.mark.parametrize(
    ("text", "found"),
    [("1.250", (3, 4)), ("-0.0050", (4, 2)), ("1.5e-3", (4, 2)), ("12", (0, 2)), ("2E+2", (-2, 1))],
)
def test_digits(text, found):
    assert digits_of(text) == found


@pytest.mark.parametrize("form", ["%.5f", "%.6g", "%.3e", "%.17g"])
def test_what_digits_leave_open_holds_and_is_no_more_than_ten_times_it(form):
    exact = 10.0 ** np.random.default_rng(0).uniform(-3, 2, 500)
    cells = [form % value for value in exact]
    values = np.array([float(cell) for cell in cells])
    opened = open_of(cells, values)
    assert np.all(np.abs(values - exact) <= opened * (1 + 1e-9))
    # Over many numbers the largest rounding nearly is what the digits leave open.
    assert np.max(np.abs(values - exact) / opened) > 0.9 or form == "%.17g"


def test_stamps_on_a_grid_are_exact_and_rounded_ones_are_not():
    grid = ["0", "0.1", "0.2", "0.3", "0.35"]
    assert np.max(open_time(grid, np.array([float(g) for g in grid]))) < 1e-16
    thirds = ["0", "0.333", "0.667", "1", "1.333"]
    opened = open_time(thirds, np.array([float(t) for t in thirds]))
    assert np.max(opened) == pytest.approx(5e-4)
