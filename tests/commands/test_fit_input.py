"""The arguments of a fit, its file, and its faults: one sentence, exit code 2, nothing written."""

import shlex
import tomllib
from xml.etree import ElementTree

import numpy as np
import pytest
from fit_traces import Truth, fitted, run_fit, write_trace
from score_line import run_score

import omegadot
from omegadot import scenario
from omegadot.commands.fit.picture import residuals_of
from omegadot.commands.score.columns import columns_of
from omegadot.commands.score.table import Table, TraceError

TIMES = np.linspace(0.0, 4.0, 61)
QUICK = ("--no-bias", "--no-damping")


@pytest.fixture
def trace(tmp_path):
    return write_trace(tmp_path / "thrown box.csv", Truth(), TIMES, attitude=True)


def cell(line, column, text):
    def edit(rows):
        cells = rows[line].split(",")
        cells[column] = text
        return [*rows[:line], ",".join(cells), *rows[line + 1 :]]

    return edit


def still(rows):
    return [rows[0], *(f"{row.split(',')[0]},0.00,0.00,0.00,1,0,0,0" for row in rows[1:])]


@pytest.mark.parametrize(
    ("edit", "arguments", "message"),
    [
        (cell(4, 2, "nan"), (), "line 5: 'wy' is nan"),
        (cell(0, 1, "roll rate"), (), "no column is an angular velocity"),
        (lambda rows: rows[:5], (), "4 samples are given; a fit needs at least 6"),
        (still, (), "omega is zero to the digits that are given"),
        (None, ("--from", "7"), "--from and --to leave 0"),
        (None, ("--from", "2", "--to", "2.1"), "a fit needs at least 6"),
        (None, ("--torque", "1,2"), "--torque 1,2: write three numbers of N m"),
        (None, ("--torque", "0,0,0"), "not all zero"),
        (None, ("--moment", "larges=1"), "there is no moment 'larges'; write largest"),
        (None, ("--moment", "x=-1"), "--moment x=-1: write a positive number of kg m^2"),
        (None, ("--moment", "x=1", "--torque", "1,0,0"), "--torque already"),
        (None, ("--mass", "0"), "--mass 0.0: give a number above 0"),
        (None, ("--name", "Not Kebab"), "give a name of lower-case letters"),
        (None, ("--rate-unit", "rad/h"), "no unit of an angular velocity"),
        (None, ("--column", "w=a,b"), "2 given, 3 columns were expected"),
        (None, ("--column", "q=qw,qx,qy,qz", "--column", "w=px,py,pz"), "no column 'px'"),
    ],
)
def test_a_fault_is_one_sentence(tmp_path, capsys, trace, edit, arguments, message):
    if edit:
        trace.write_text("\n".join(edit(trace.read_text().splitlines())) + "\n")
    out = tmp_path / "fitted.toml"
    result = run_fit(capsys, trace, *arguments, *QUICK, "--out", out)
    assert (result.code, result.out) == (2, ""), result.out
    assert message in result.err
    assert result.err.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == [trace.name]


def test_omega_is_needed(tmp_path, capsys):
    path = tmp_path / "attitude.csv"
    path.write_text("t,qw,qx,qy,qz\n" + "".join(f"{k},1,0,0,0\n" for k in range(9)))
    result = run_fit(capsys, path)
    assert result.code == 2
    assert "no column is an angular velocity, which a fit needs" in result.err


@pytest.mark.parametrize("name", ["gyro_{}", "angular_velocity.{}", "Omega_{} (rad/s)"])
def test_omega_is_found_under_the_names_that_logs_give_it(name):
    """Caught: a gyro's log that is read only after its columns are mapped by hand."""
    names = ["time", *map(name.format, "xyz")]
    found = columns_of(Table("log.csv", tuple(names), []), [], "wxyz", "ZYX")
    assert [found[role] for role in ("t", "wx", "wy", "wz")] == names


def test_of_two_sets_that_may_be_omega_none_is_taken():
    """Caught: the raw rates fitted where the filtered ones were meant."""
    names = ["time", *map("gyro_{}".format, "xyz"), *map("omega_{}".format, "xyz")]
    with pytest.raises(TraceError, match="no column is an angular velocity"):
        columns_of(Table("log.csv", tuple(names), []), [], "wxyz", "ZYX")
    own = columns_of(Table("log.csv", (*names, "wx", "wy", "wz"), []), [], "wxyz", "ZYX")
    assert own["wx"] == "wx"


def test_the_scenario_scores_the_trace_that_it_was_fitted_to(tmp_path, capsys, trace):
    """With the very command that is printed, whose exit code is 0, and the errors are tiny."""
    out = tmp_path / "fitted.toml"
    result = run_fit(capsys, trace, *QUICK, "--out", out, "--mass", "2.5", "--name", "box")
    assert result.code == 0, result.err
    line = next(line for line in result.out.splitlines() if line.startswith("Score the trace: "))
    words = shlex.split(line.removeprefix("Score the trace: "))
    assert words[:2] == ["omegadot", "score"]
    score = run_score(capsys, *words[2:], "--out", tmp_path / "score", "--format", "json")
    assert score.code == 0, score.err
    assert score.json["channels"]["omega"]["max"] < 1e-9
    assert score.json["channels"]["attitude"]["max"] < 1e-8
    written = scenario(str(out))
    assert (written.name, written.body.mass) == ("box", 2.5)
    assert tomllib.loads(out.read_text())["run"]["duration"] == TIMES[-1]


def test_the_picture_stands_beside_the_scenario_and_replaces_none_but_its_own(
    tmp_path, capsys, trace
):
    """It shows the trace and what the motion leaves of it."""
    out, drawn = tmp_path / "box.toml", tmp_path / "box.svg"
    drawn.write_text("<svg>somebody else's</svg>")
    result = run_fit(capsys, trace, *QUICK, "--out", out)
    assert result.code == 2
    assert "box.svg" in result.err
    assert not out.exists()
    drawn.unlink()
    found = omegadot.fit(trace, bias=False, damping=False, out=out)
    left = residuals_of(found)
    np.testing.assert_allclose(np.sqrt(np.mean(left**2, axis=0)), found.rms, rtol=1e-6)
    picture = ElementTree.parse(drawn).getroot()
    dots = [p.get("d") for p in picture.iter() if p.get("class") in ("d c0", "d c1", "d c2")]
    assert [d.count("h0") for d in dots] == [len(TIMES)] * 6
    omegadot.fit(trace, bias=False, damping=False, out=out)  # its own is replaced


@pytest.mark.parametrize("unit", ["rad/s", "deg/s"])
def test_the_bias_is_passed_on_and_subtracted(tmp_path, capsys, unit):
    """In the axes and the unit of the trace; what remains is noise, at the first sample too."""
    truth = Truth(bias=np.array([0.03, -0.02, 0.05]))
    path = write_trace(tmp_path / "gyro.csv", truth, np.linspace(0.0, 12.0, 601), 0.01, 3)
    if unit == "deg/s":
        rows = np.loadtxt(path, delimiter=",", skiprows=1)
        rows[:, 1:] = np.rad2deg(rows[:, 1:])
        np.savetxt(path, rows, "%.17g", ",", header="time,wx,wy,wz", comments="")
    axes = ("--rate-unit", unit, "--body-axes", "y,z,x")
    out = tmp_path / "fitted.toml"
    result = run_fit(capsys, path, *axes, "--bias", "--no-damping", "--out", out)
    assert result.code == 0, result.err
    line = next(line for line in result.out.splitlines() if line.startswith("Score the trace: "))
    arguments = shlex.split(line.removeprefix("Score the trace: "))[1:]
    given = next(text for text in arguments if text.startswith("--omega-bias="))
    found = np.array([float(part) for part in given.partition("=")[2].split(",")])
    assert np.abs(found * np.deg2rad(1.0) ** (unit == "deg/s") - truth.bias).max() < 0.01
    score = run_score(capsys, *arguments[1:], "--out", tmp_path / "score")
    assert "The remaining error of omega looks like noise" in score.out
    assert "The first sample is not" not in score.out
    without = [text for text in arguments[1:] if text != given]
    score = run_score(capsys, *without, "--out", tmp_path / "score")
    assert "The first sample is not the scenario's state: omega" in score.out


def test_units_that_cannot_be_are_questioned(tmp_path, capsys):
    path = write_trace(tmp_path / "ms.csv", Truth(), TIMES)
    rows = np.loadtxt(path, delimiter=",", skiprows=1)
    rows[:, 0] *= 1e3
    np.savetxt(path, rows, "%.17g", ",", header="time,wx,wy,wz", comments="")
    result = run_fit(capsys, path)
    assert result.code == 2
    assert "read in rad/s (the default) and s (the default), the body turns by" in result.err
    looks = "omega looks like mrad/s or the time looks like ms; "
    assert f"{looks}give --rate-unit mrad/s or give --time-unit ms." in result.err


def test_a_window_in_other_units_is_scored_from_its_start(tmp_path, capsys):
    """Times in ms from 12 s on, omega in deg/s: the options are passed on, with the offset."""
    truth = Truth(damping=0.02)
    path = write_trace(tmp_path / "late.csv", truth, TIMES)
    rows = np.loadtxt(path, delimiter=",", skiprows=1)
    rows[:, 0] = 1e3 * (rows[:, 0] + 12.0)
    rows[:, 1:] = np.rad2deg(rows[:, 1:])
    np.savetxt(path, rows, "%.17g", ",", header="ms,p,q,r", comments="")
    out = tmp_path / "fitted.toml"
    units = ("--time-unit", "ms", "--rate-unit", "deg/s", "--column", "t=ms", "--column", "w=p,q,r")
    result = run_fit(capsys, path, *units, "--from", "13", "--no-bias", "--out", out)
    assert result.code == 0, result.err
    line = next(line for line in result.out.splitlines() if line.startswith("Score the trace: "))
    assert "--rate-unit deg/s" in line
    words = shlex.split(line)
    assert 13.0 <= float(words[words.index("--time-offset") + 1]) < 13.1
    assert scenario(str(out)).load.damping == pytest.approx(0.02, abs=1e-8)


def test_the_models_that_were_compared_are_listed(tmp_path, capsys):
    truth = Truth(damping=0.05)
    found = fitted(capsys, write_trace(tmp_path / "trace.csv", truth, TIMES, 0.02, 2))
    rms = {tuple(model["terms"]): model["rms"] for model in found["models"]}
    assert set(rms) == {(), ("bias",), ("damping",), ("bias", "damping")}
    assert rms[()] > rms["damping",]
    chosen = [model["terms"] for model in found["models"] if model["chosen"]]
    assert chosen == [["damping"]]
    assert found["chances"]["damping"] < 0.01 < found["chances"]["bias"]
