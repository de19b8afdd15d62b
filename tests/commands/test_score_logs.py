"""Logs as they come: epochs and dates, windows, rates, gaps, missing columns."""

from datetime import UTC, datetime, timedelta

import numpy as np
import polars as pl
import pytest
from score_line import BRICK, run_score, tumble

from omegadot.commands.score.csv_table import csv_table
from omegadot.commands.score.dates import as_date, seconds_of
from omegadot.commands.score.stamps import instant

TIMES = np.arange(21.0)
RATES = np.rad2deg(tumble(TIMES)[:, :3])
BEGIN = 1693838903
MAPPED = ("--scenario", BRICK, "--rate-unit", "deg/s")


def numbers(row, delimiter=","):
    return delimiter.join(f"{value:.6f}" for value in row)


def written(path, stamps, rates=RATES, head="time,wx,wy,wz"):
    """A log with these stamps, as texts."""
    rows = [f"{stamp},{numbers(row)}" for stamp, row in zip(stamps, rates, strict=True)]
    path.write_text("\n".join([head, *rows]) + "\n")
    return path


@pytest.fixture
def score(tmp_path, capsys):
    def scored(trace, *arguments):
        out = tmp_path / "out"
        # A search for conventions takes no unit, and writes nothing.
        read = MAPPED[:2] if "--detect" in arguments else (*MAPPED, "--out", out)
        return run_score(capsys, trace, *read, "--format", "json", *arguments)

    return scored


def passes(result):
    assert result.code == 0, result.err
    return {channel["verdict"] for channel in result.json["channels"].values()} == {"pass"}


def followed(message):
    """The options that a message advises."""
    advice = message.partition("; give ")[2].partition(" if the motion")[0]
    return advice.split()


DATES = [datetime.fromtimestamp(BEGIN + t, UTC).replace(tzinfo=None) for t in TIMES]
STAMPS = {
    "s": [str(BEGIN + int(t)) for t in TIMES],
    "ms": [str((BEGIN + int(t)) * 1000) for t in TIMES],
    "us": [str((BEGIN + int(t)) * 10**6) for t in TIMES],
    "ns": [str((BEGIN + int(t)) * 10**9 + 123456789) for t in TIMES],
    "fractions": [f"{BEGIN + int(t)}.123456" for t in TIMES],
    "date": [f"{date.isoformat()}Z" for date in DATES],
    "date with a blank": [date.strftime("%Y-%m-%d %H:%M:%S.%f") for date in DATES],
    "date with a zone": [f"{(d + timedelta(hours=2)).isoformat()}+02:00" for d in DATES],
    "time of day": [date.strftime("%H:%M:%S.%f")[:-3] for date in DATES],
    "not an epoch": [f"{t + 12.10006:.5f}" for t in TIMES],
}


@pytest.mark.parametrize("form", STAMPS)
def test_the_advice_for_stamps_that_begin_elsewhere_ends_where_it_fits(score, tmp_path, form):
    trace = written(tmp_path / "log.csv", STAMPS[form])
    refused = score(trace)
    assert refused.code == 2
    result = score(trace, *followed(refused.err))
    assert passes(result)
    assert result.json["channels"]["omega"]["bound"] < np.deg2rad(1e-5)


@pytest.mark.parametrize("unit", ["s", "ms", "us", "ns"])
@pytest.mark.parametrize("declared", ["ms", "us", "ns", "min"])
def test_a_wrong_unit_is_never_scored(score, tmp_path, unit, declared):
    if unit == declared:
        return
    trace = written(tmp_path / "log.csv", STAMPS[unit])
    assert score(trace, "--time-unit", declared).code == 2
    assert score(trace, "--time-unit", declared, "--time-offset", str(BEGIN)).code == 2


def test_an_offset_that_was_rounded_is_corrected_in_full(score, tmp_path):
    trace = written(tmp_path / "log.csv", STAMPS["not an epoch"])
    assert "--time-offset 12.10006 " in score(trace, "--time-offset", "12.1001").err
    assert passes(score(trace, "--time-offset", "12.10006"))


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("1970-01-02T00:00:00", "86400"),
        ("1970-01-01 00:00:01.50", "1.50"),
        ("1970-01-01T02:00:00+02:00", "0"),
        ("1970-01-01T00:00:00-0030", "1800"),
        ("19700101T000001Z", "1"),
        ("00:01:00,25", "60.25"),
        ("1969-12-31T23:59:59.25Z", "-0.75"),
        ("2025-02-30T00:00:00", None),
        ("123456", None),
    ],
)
def test_dates_are_seconds(text, seconds):
    assert seconds_of(text) == seconds


def test_a_date_survives_its_number():
    for text in ("2025-03-01T12:00:00.25", "12:00:00", "1969-12-31T23:59:59"):
        assert as_date(instant(text, "")) == text


def test_dates_and_whole_numbers_of_a_parquet_file(score, tmp_path):
    columns = {f"w{axis}": RATES[:, k] for k, axis in enumerate("xyz")}
    dates = [date + timedelta(milliseconds=1.5) for date in DATES]
    path = tmp_path / "log.parquet"
    pl.DataFrame({"time": dates, **columns}).write_parquet(path)
    assert passes(score(path, *followed(score(path).err)))
    ticks = [(BEGIN + int(t)) * 10**9 + 5 for t in TIMES]  # more digits than a double has
    pl.DataFrame({"time": ticks, **columns}).write_parquet(path)
    result = score(path, "--time-unit", "ns", "--time-offset", f"{BEGIN}.000000005")
    assert passes(result)
    assert result.json["channels"]["omega"]["bound"] < 1e-12


def test_repeated_stamps_are_named_by_line_whoever_reads_them(score, tmp_path):
    stamps = STAMPS["s"].copy()
    stamps[8] = stamps[7]
    trace = written(tmp_path / "log.csv", stamps)
    for arguments in ((), ("--detect",)):
        found = score(trace, *arguments)
        assert found.code == 2
        assert f"line 9 and line 10: the time {stamps[7]} is repeated" in found.err
    # A window that holds one of the two has no repetition.
    window = ("--time-offset", str(BEGIN), "--to", str(BEGIN + 6))
    assert score(trace, *window).json["samples"] == 7


def test_gaps_are_counted(score, tmp_path):
    kept = np.delete(np.arange(21), [7, 8, 15])
    trace = written(tmp_path / "log.csv", TIMES[kept], RATES[kept])
    (line,) = [s for s in score(trace).json["sentences"] if "gaps" in s]
    assert "2 gaps" in line
    assert "3 s after line 8, 2 s after line 14; 3 samples are missing" in line
    whole = written(tmp_path / "log.csv", TIMES)
    assert not any("gap" in s for s in score(whole).json["sentences"])


def test_a_rate_stands_for_missing_times(score, tmp_path):
    trace = tmp_path / "log.csv"
    trace.write_text("\n".join(["wx,wy,wz", *(numbers(row) for row in RATES)]))
    assert "or give --rate" in score(trace).err
    assert passes(score(trace, "--rate", "1"))
    assert not passes(score(trace, "--rate", "1.01"))
    result = score(trace, "--rate", "1", "--from", "3", "--to", "9")
    assert passes(result)
    assert result.json["samples"] == 7
    assert "give a number above 0" in score(trace, "--rate", "0").err
    detected = score(trace, "--rate", "1", "--detect")
    assert "--rate 1.0" in detected.json["fitting"][0]["options"]


def test_a_window_leaves_out_what_cannot_be_read(score, tmp_path):
    trace = written(tmp_path / "log.csv", TIMES)
    text = trace.read_text().replace("time,wx,wy,wz\n", "time,wx,wy,wz\n-2,nan,nan,\n-1,,,\n")
    trace.write_text(text)
    assert "line 2: 'wx' is nan" in score(trace).err
    assert passes(score(trace, "--from", "0"))
    assert score(trace, "--from", "2", "--to", "5").json["samples"] == 4
    assert "leave 1 of the samples" in score(trace, "--from", "20").err
    assert "neither a number of seconds nor a date" in score(trace, "--from", "noon").err
    dated = written(tmp_path / "dated.csv", STAMPS["date"])
    window = ("--from", STAMPS["date"][2], "--to", STAMPS["date"][5])
    assert score(dated, "--time-offset", STAMPS["date"][0], *window).json["samples"] == 4


@pytest.mark.parametrize("axes", ["xz", "y", "xyz"])
def test_some_axes_of_a_gyro_are_enough(score, tmp_path, axes):
    places = ["xyz".index(axis) for axis in axes]
    head = ",".join(["time", *(f"w{axis}" for axis in axes)])
    trace = written(tmp_path / "log.csv", TIMES, RATES[:, places], head)
    result = score(trace)
    assert passes(result)
    assert set(result.json["channels"]) == (
        {"omega", "energy", "angular_momentum"} if axes == "xyz" else {"omega"}
    )
    wrong = RATES[:, places].copy()
    wrong[:, 0] += 0.01
    off = score(written(tmp_path / "off.csv", TIMES, wrong, head)).json["channels"]["omega"]
    assert off["max"] == pytest.approx(np.deg2rad(0.01), rel=1e-3)
    late = np.rad2deg(tumble(np.clip(TIMES - 0.002, 0, None))[:, places])
    shift = score(written(tmp_path / "late.csv", TIMES, late, head)).json["shift"]
    assert shift["seconds"] == pytest.approx(-0.002, rel=1e-3)


def test_axes_that_are_turned_need_the_whole_vector(score, tmp_path):
    swapped = np.column_stack([RATES[:, 1], -RATES[:, 2]])
    trace = written(tmp_path / "log.csv", TIMES, swapped, "time,wx,wz")
    assert passes(score(trace, "--body-axes=y,x,-z"))
    assert "map all three" in score(trace, "--body-axes", "0.6,0,0.8,0").err


def test_columns_that_have_a_known_name_can_be_left_out(score, tmp_path):
    speeds = np.column_stack([RATES, np.full((21, 2), 5.0)])
    trace = written(tmp_path / "log.csv", TIMES, speeds, "time,wx,wy,wz,vx,vz")
    found = score(trace, "--column", "v=")
    assert passes(found)
    assert "linear_momentum" in found.json["not_given"]
    mapped = tmp_path / "map.toml"
    mapped.write_text("[columns]\nv = []\n")
    assert passes(score(trace, "--map", mapped))


def test_names_that_are_repeated_matter_only_where_they_are_used(score, tmp_path):
    speeds = np.column_stack([RATES, np.zeros((21, 2))])
    head = "time,wx,wy,wz,vz,vz"
    assert passes(score(written(tmp_path / "log.csv", TIMES, speeds, head)))
    assert score(tmp_path / "log.csv", "--detect").code == 0
    twice = written(tmp_path / "twice.csv", TIMES, speeds, "time,wx,wy,wz,n,Time")
    assert "time,wx" in twice.read_text()
    clash = written(tmp_path / "clash.csv", TIMES, speeds, "time,wx,wy,wz,n,time")
    assert "two columns have the name 'time'" in score(clash).err


TABLES = {
    "a last column that fills later": "t,wx,gps\n0,1,\n1,3,\n2,5,47.1\n",
    "between blanks": "t wx gps\n0 1\n1 3\n2 5 47.1\n",
    "two of them": "t,wx,gps,fix\n0,1,,\n1,3,,\n2,5,47.1,3\n",
    "without any header": "0,1,\n1,3,\n2,5,47.1\n",
    "a header in a comment": "# t,wx,gps\n0,1,\n1,3,\n2,5,47.1\n",
    "a last column that is empty": "t,wx,note\n0,1,\n1,3,\n2,5,\n",
    "decimal commas beside semicolons": "t;wx\n0;1,0\n1;3,0\n2;5,0\n",
    "decimal commas beside tabs": "t\twx\n0,0\t1,0\n1,0\t3,0\n2,0\t5,0\n",
    "names between commas over blanks": "# t, wx, gps\n0 1 1\n1 3 1\n2 5 1\n",
    "a word before the names": "# columns: t wx gps\n0 1 1\n1 3 1\n2 5 1\n",
    "units behind a blank": "# made at: 12:00 today, again\n#t (s)   wx (deg/s)\n0 1\n1 3\n2 5\n",
    "two blanks over commas": "#t (s)   wx (deg/s)\n0,1\n1,3\n2,5\n",
}


@pytest.mark.parametrize("form", TABLES)
def test_tables_are_read_whatever_stands_in_the_columns_that_are_not_used(form):
    table = csv_table("log", TABLES[form].encode())
    assert list(table.column(table.names[1]).values) == [1.0, 3.0, 5.0]
    assert [name.split()[0] for name in table.names[:2]] in (["t", "wx"], ["#1", "#2"])
    assert table.names[0] != "#1" or form == "without any header"


def test_units_in_a_name_do_not_hide_it(score, tmp_path):
    head = "Time [s],wx (deg/s),WY (deg/s),wz(deg/s)"
    assert passes(score(written(tmp_path / "log.csv", TIMES, head=head)))
    trace = written(tmp_path / "log.csv", TIMES, head="when [s],p (deg/s),q (deg/s),r (deg/s)")
    assert passes(score(trace, "--column", "t=when", "--column", "w=p,q,r"))


def test_a_saturated_gyro_is_noticed(score, tmp_path):
    times = 0.1 * np.arange(301)
    rates = np.rad2deg(tumble(times)[:, :3])
    stamps = [f"{t:.1f}" for t in times]
    clipped = rates.copy()
    clipped[:, 2] = np.minimum(clipped[:, 2], 32.0)
    stuck = rates.copy()
    stuck[100:120, 0] = stuck[100, 0]
    whole = rates.copy()
    whole[:, 2] = 225.048065
    for column, what in ((clipped, "wz is at its largest value, 32"), (stuck, "looks stale")):
        sentences = score(written(tmp_path / "log.csv", stamps, column)).json["sentences"]
        assert any(what in line for line in sentences)
    sentences = score(written(tmp_path / "log.csv", stamps, whole)).json["sentences"]
    assert any("wz is 225.048065 throughout (301 samples)" in line for line in sentences)
    sentences = score(written(tmp_path / "log.csv", stamps, rates)).json["sentences"]
    assert not any("saturated" in line or "stale" in line for line in sentences)


SPIN = """schema = 1
name = "spin"
title = "A steady spin"
[body]
mass = 1.0
inertia = [1.0, 1.0, 1.0]
[initial]
angular_velocity = [0.24682682989768706, -0.24682682989768706, 0.0]
[run]
duration = 10.0
timesteps = [0.1, 0.05, 0.025]
sample = 0.1
"""


@pytest.mark.parametrize(
    ("cells", "opened"),
    [
        ("0.2468,-0.2468,0.0000", np.sqrt(2.0) * 5e-5),  # decimals, however constant
        ("0.246827,-0.246827,0", np.sqrt(2.0) * 5e-7),
        ("0.24682682989768706,-0.24682682989768706,0", 1e-16),  # printed whole
    ],
)
def test_constant_columns_are_open_by_their_digits(tmp_path, capsys, cells, opened):
    scenario, trace = tmp_path / "spin.toml", tmp_path / "log.csv"
    scenario.write_text(SPIN)
    trace.write_text("t,wx,wy,wz\n" + "".join(f"{t},{cells}\n" for t in range(11)))
    out = ("--out", tmp_path / "out", "--format", "json")
    found = run_score(capsys, trace, "--scenario", scenario, *out)
    assert passes(found)
    assert found.json["channels"]["omega"]["digits_open"] == pytest.approx(opened, rel=0.5)
