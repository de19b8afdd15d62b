"""A unit in a column's name is used, and one that contradicts an option is refused."""

import json
import shlex

import numpy as np
import pytest
from fit_traces import Truth, fitted, run_fit, write_trace
from score_line import BRICK, run_score, tumble, write_brick

import omegadot
from omegadot.commands.score.named_units import unit_in
from omegadot.commands.score.table import TraceError

TIMES = np.linspace(0.0, 4.0, 61)
HEAD = "time,p (deg/s),q (deg/s),r (deg/s),yaw (deg),pitch (deg),roll [°]"
W = ("--scenario", BRICK, "--column", "w=p,q,r")


def brick(path, head):
    """The brick, in s, deg/s and deg, whatever its header says."""
    times = 0.5 * np.arange(11)
    rows = write_brick(path, times, tumble(times)).read_text().splitlines()
    path.write_text("\n".join([head, *rows[1:]]) + "\n")
    return path


def gyro(path, head, scale=180.0 / np.pi):
    rows = np.loadtxt(write_trace(path, Truth(), TIMES), delimiter=",", skiprows=1)
    rows[:, 1:] *= scale
    np.savetxt(path, rows, "%.17g", ",", header=head, comments="")
    return path


@pytest.mark.parametrize(
    ("name", "role", "unit"),
    [
        ("gyro_x (deg/s)", "wx", "deg/s"),
        ("wx [°/s]", "wx", "deg/s"),
        ("wx (Degrees/sec)", "wx", "deg/s"),
        ("wx (deg s^-1)", "wx", "deg/s"),
        ("wx (dps)", "wx", "deg/s"),
        ("wx (RPM)", "wx", "rpm"),
        ("wx (µrad/s)", "wx", "urad/s"),
        ("time (ms)", "t", "ms"),
        ("yaw (deg)", "e1", "deg"),
        ("px (in)", "px", "in"),
        ("vx (ft/s)", "vx", "ft"),
        ("ax (deg/s^2)", "ax", "deg/s"),
        ("ax (rad/s²)", "ax", "rad/s"),
        ("qw (1)", "qw", None),
        ("wx (filtered)", "wx", None),
        ("time (m/d/y)", "t", None),
        ("wx", "wx", None),
    ],
)
def test_units_of_names(name, role, unit):
    assert unit_in(name, role) == unit


def test_a_fit_reads_the_unit_of_the_name_and_score_reads_it_alike(tmp_path, capsys):
    """Caught: a body fitted to deg/s taken as rad/s, with exit code 0."""
    named = gyro(tmp_path / "named.csv", "time,gyro_x (deg/s),gyro_y (deg/s),gyro_z (deg/s)")
    plain = gyro(tmp_path / "plain.csv", "time,gyro_x,gyro_y,gyro_z")
    own, declared = fitted(capsys, named), fitted(capsys, plain, "--rate-unit", "deg/s")
    assert own["moments"] == declared["moments"]
    assert own["omega"] == pytest.approx(Truth().start, rel=1e-6)
    result = run_fit(capsys, named, "--out", tmp_path / "box.toml")
    line = next(line for line in result.out.splitlines() if line.startswith("Score the trace: "))
    words = shlex.split(line.removeprefix("Score the trace: "))[2:]
    score = run_score(capsys, *words, "--out", tmp_path / "score", "--format", "json")
    assert score.code == 0, score.err
    assert score.json["channels"]["omega"]["max"] < 1e-6


def test_score_reads_the_units_of_names(tmp_path, capsys):
    """The option says the same, or nothing; a unit holds for what the option would hold for."""
    path = brick(tmp_path / "trace.csv", HEAD)
    for more in ((), ("--rate-unit", "deg/s", "--angle-unit", "deg")):
        result = run_score(capsys, path, *W, *more, "--format", "json", "--out", tmp_path / "out")
        assert result.code == 0, result.err
        assert result.json["channels"]["omega"]["max"] < 1e-9
    found = omegadot.score(path, BRICK, columns=["w=p,q,r"])
    assert found.found.reading.how.rate_unit == "deg/s"


@pytest.mark.parametrize(
    ("head", "more", "message"),
    [
        (
            HEAD,
            ("--rate-unit", "rad/s"),
            "'p (deg/s)' has the unit deg/s, and --rate-unit is rad/s",
        ),
        (
            HEAD.replace("time", "time (ms)"),
            ("--time-unit", "s"),
            "has the unit ms, and --time-unit",
        ),
        (HEAD.replace("q (deg/s)", "q (rad/s)"), (), "'p (deg/s)' and 'q (rad/s)' have different"),
        (HEAD.replace("q (deg/s)", "q (deg)"), (), "an angular velocity, and deg is none; give"),
        (HEAD.replace("(deg/s)", "(rad/s)"), (), "deg/s; correct the unit in the name of column"),
        (HEAD.replace("time", "time (h)"), (), "column 'time (h)' to s"),
    ],
)
def test_a_contradiction_is_one_sentence(tmp_path, capsys, head, more, message):
    """Caught: rates in rad/s under a header that says deg/s, accepted without a word."""
    path = brick(tmp_path / "trace.csv", head)
    result = run_score(capsys, path, *W, *more, "--out", tmp_path / "out")
    assert (result.code, result.out) == (2, "")
    assert message in result.err
    assert result.err.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_a_fit_refuses_the_same_contradiction(tmp_path, capsys):
    path = gyro(tmp_path / "log.csv", "time,gyro_x (deg/s),gyro_y (deg/s),gyro_z (deg/s)")
    result = run_fit(capsys, path, "--rate-unit", "rad/s")
    assert result.code == 2
    assert "has the unit deg/s, and --rate-unit is rad/s; leave out the option" in result.err
    mapped = tmp_path / "map.toml"
    mapped.write_text('rate-unit = "rpm"\n')
    with pytest.raises(TraceError, match="--rate-unit is rpm"):
        omegadot.fit(path, map_file=mapped)


def test_an_option_says_what_a_name_of_another_quantity_does_not(tmp_path, capsys):
    path = brick(tmp_path / "trace.csv", HEAD.replace("(deg/s)", "(deg)"))
    result = run_score(
        capsys, path, *W, "--rate-unit", "deg/s", "--format", "json", "--out", tmp_path / "out"
    )
    assert json.loads(result.out)["channels"]["omega"]["max"] < 1e-9


def test_what_is_detected_leaves_out_what_names_say(tmp_path):
    """Caught: an option that says what names say, or none where they say something else."""
    read = omegadot.detect(brick(tmp_path / "trace.csv", HEAD), BRICK).fitting[0].arguments()
    assert not {"rate_unit", "angle_unit"} & read.keys()
    wrong = brick(tmp_path / "wrong.csv", HEAD.replace("(deg/s)", "(rad/s)"))
    assert omegadot.detect(wrong, BRICK).fitting[0].arguments()["rate_unit"] == "deg/s"
