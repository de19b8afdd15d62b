"""Traces of the tumbling brick, made elsewhere: measured rightly, and reported what is wrong."""

import numpy as np
import polars as pl
import pytest
from score_line import (
    BRICK,
    INERTIA,
    MAPPED,
    run_score,
    runge_kutta,
    tumble,
    turns,
    write_brick,
)

from omegadot.reports.page.page import draw_page
from omegadot.reports.record.record import read_record
from omegadot.reports.summary.summary import summarise

TIMES = 0.1 * np.arange(301)


@pytest.fixture
def score(tmp_path, capsys):
    """Score a brick's trace, with a folder of its own; the answer for machines."""

    def scored(times, states, *arguments, form="%.17g"):
        trace = write_brick(tmp_path / "trace.csv", times, states, form)
        out = tmp_path / "out"
        return run_score(capsys, trace, *MAPPED, "--out", out, "--format", "json", *arguments)

    return scored


def independent(states, exact):
    """Largest errors of omega in rad/s and attitude in rad, and of |H| over |H|."""
    spin = np.linalg.norm(states[:, :3] - exact[:, :3], axis=1).max()
    turn = (turns(states).inv() * turns(exact)).magnitude().max()
    momenta = [turns(s).apply(INERTIA * s[:, :3]) for s in (states, exact)]
    drift = np.linalg.norm(momenta[0] - momenta[1], axis=1) / np.linalg.norm(momenta[1][0])
    return spin, turn, drift.max()


@pytest.mark.parametrize("step", [0.05, 0.1, 0.3])
def test_errors_of_a_scheme_are_those_of_an_independent_computation(score, step):
    count = round(30.0 / step)
    times, states = step * np.arange(count + 1), runge_kutta(step, count)
    found = score(times, states).json["channels"]
    spin, turn, drift = independent(states, tumble(times))
    assert found["omega"]["max"] == pytest.approx(spin, rel=0.01)
    assert found["attitude"]["max"] == pytest.approx(turn, rel=0.01)
    assert found["angular_momentum"]["max"] == pytest.approx(drift, rel=0.01)
    assert {channel["verdict"] for channel in found.values()} == {"info"}


@pytest.mark.parametrize("shift", [0.00032, -0.002, 0.4])
def test_a_late_trace_is_reported_late(score, shift):
    late = tumble(np.clip(TIMES - shift, 0.0, None))
    start = 0 if shift < 0 else int(np.ceil(shift / 0.1)) + 1
    found = score(TIMES[start:], late[start:]).json["shift"]
    assert found["explains"]
    assert found["seconds"] == pytest.approx(-shift, rel=1e-6)
    assert found["note"].startswith("late" if shift > 0 else "early")
    assert found["after"] < 1e-10 < 1e-6 < found["before"]


def test_an_integrator_s_error_is_not_reported_late(score):
    found = score(TIMES, runge_kutta(0.1, 300)).json["shift"]
    assert not found["explains"]


def test_noise_is_reported_as_noise_and_not_late(score):
    states = tumble(TIMES)
    noise = 1e-5 * np.random.default_rng(3).standard_normal((301, 3))
    states[:, :3] += noise
    found = score(TIMES, states).json
    assert found["channels"]["omega"]["max"] == pytest.approx(
        np.linalg.norm(noise, axis=1).max(), rel=0.01
    )
    assert not found["shift"]["explains"]
    assert found["shift"]["noise"] == pytest.approx(1e-5, rel=0.1)
    assert any("looks like noise" in line for line in found["sentences"])
    # That of the first sample is as large as any other's.
    assert not any("not the scenario's state" in line for line in found["sentences"])


@pytest.mark.parametrize("form", ["%.4f", "%.8f", "%.7g", "%.3e"])
def test_the_printed_digits_are_part_of_the_bound(score, form):
    found = score(TIMES, tumble(TIMES), form=form).json
    for channel in ("omega", "attitude", "energy", "angular_momentum"):
        measured = found["channels"][channel]
        assert measured["verdict"] == "pass", channel
        # A bound a thousand times too wide would hide what the digits do show.
        assert measured["max"] > 1e-3 * measured["bound"]


def test_an_error_above_the_digits_is_not_passed(score):
    states = tumble(TIMES)
    states[:, 0] += np.deg2rad(2e-4)
    found = score(TIMES, states, form="%.4f").json["channels"]
    assert found["omega"]["verdict"] == "info"


def test_samples_may_stand_anywhere(score):
    times = np.sort(np.random.default_rng(5).uniform(0.0, 30.0, 120))
    states = tumble(times)
    found = score(times, states, form="%.9f").json["channels"]
    assert {channel["verdict"] for channel in found.values()} == {"pass"}


def test_a_declared_scheme_explains_the_error(score):
    arguments = ("--integrator-scheme", "rk4-quaternion", "--timestep", "0.1")
    result = score(TIMES[::3], runge_kutta(0.1, 300)[::3], *arguments)
    assert result.code == 0
    assert {c["kind"] for c in result.json["channels"].values()} == {"explained"}
    (task,) = result.json["tasks"]
    assert task["gates"] == {"scheme": "pass", "invariants": "pass", "trajectory": "pass"}


def test_another_scheme_than_declared_fails_and_is_named(score):
    arguments = ("--integrator-scheme", "lie-rk4", "--timestep", "0.1")
    result = score(TIMES, runge_kutta(0.1, 300), *arguments)
    assert result.code == 1
    assert any("equals rk4-quaternion" in line for line in result.json["sentences"])


def test_a_step_alone_has_the_scheme_named_but_nothing_green(score):
    result = score(TIMES, runge_kutta(0.1, 300), "--timestep", "0.1")
    assert result.code == 0
    assert any("equals rk4-quaternion" in line for line in result.json["sentences"])
    assert {c["verdict"] for c in result.json["channels"].values()} == {"info"}


def test_requirements_are_met_or_missed(score):
    states = runge_kutta(0.1, 300)
    result = score(TIMES, states, "--attitude", "1e-4deg", "--flip-time", "1ms", "--energy", "1e-6")
    assert result.code == 0
    result = score(TIMES, states, "--attitude", "1e-6deg", "--omega", "1deg/s")
    assert result.code == 1
    verdicts = {r["channel"]: r["verdict"] for r in result.json["requirements"]}
    assert verdicts == {"attitude": "fail", "omega": "pass"}


def test_omega_alone_is_a_trace_and_the_rest_is_not_green(tmp_path, capsys):
    table = np.column_stack([TIMES, tumble(TIMES)[:, :3]])
    trace = tmp_path / "spin.csv"
    np.savetxt(trace, table, fmt="%.17g", delimiter=",", header="t,wx,wy,wz", comments="")
    out = tmp_path / "out"
    result = run_score(
        capsys, trace, "--scenario", BRICK, "--out", out, "--format", "json", "--name", "gyro"
    )
    assert set(result.json["channels"]) == {"omega", "energy", "angular_momentum"}
    assert set(result.json["not_given"]) == {"attitude", "position", "linear_momentum"}
    metrics = pl.read_parquet(out / "metrics.parquet").filter(engine="gyro")
    absent = metrics.filter(pl.col("channel").is_in(["attitude", "position", "linear_momentum"]))
    assert set(absent.get_column("verdict")) == {"info"}
    stored = pl.read_parquet(out / "trajectories.parquet")
    assert stored.filter(engine="gyro").get_column("qw").is_nan().all()
    assert np.array_equal(stored.filter(engine="exact").get_column("time"), TIMES)
    # The folder is a record like any other, and its page states what the trace is.
    record = read_record(out)
    assert "gyro on nesc-checkcase-2 is off at most: omega by" in draw_page(record)
    (task,) = summarise(record).runs.elements()
    assert task == "not-judged"


def test_omega_dot_is_held_against_the_equation(tmp_path, capsys):
    states = tumble(TIMES)
    spin = states[:, :3]
    wrong = np.cross(spin, INERTIA * spin) / INERTIA  # the sign of equation (9) as printed
    verdicts = []
    for number, rates in enumerate((-wrong, wrong)):
        trace = tmp_path / f"{number}.csv"
        head = "t,wx,wy,wz,ax,ay,az"
        table = np.column_stack([TIMES, spin, rates])
        np.savetxt(trace, table, fmt="%.17g", delimiter=",", header=head, comments="")
        arguments = ("--scenario", BRICK, "--column", "a=ax,ay,az", "--format", "json")
        result = run_score(capsys, trace, *arguments, "--out", tmp_path / "out")
        verdicts.append(result.json["tasks"][0]["gates"]["equation"])
    assert verdicts == ["pass", "info"]


def test_an_engine_runs_with_the_trace(score, tmp_path):
    arguments = ("--with", "reference:rk4-quaternion", "--name", "elsewhere")
    result = score(TIMES, runge_kutta(0.1, 300), *arguments)
    engines = {task["engine"] for task in result.json["tasks"]}
    assert engines == {"elsewhere", "reference"}
    page = (tmp_path / "out" / "report.html").read_text()
    assert "elsewhere" in page
    assert result.code == 0


def test_a_scheme_from_a_rounded_start_is_explained_but_not_green(score):
    states = runge_kutta(0.1, 300, np.array([*np.deg2rad([10.0, 20.0, 30.001]), 1, 0, 0, 0]))
    arguments = ("--integrator-scheme", "rk4-quaternion", "--timestep", "0.1")
    result = score(TIMES, states, *arguments, form="%.12g")
    assert result.code == 0
    found = result.json["channels"]
    assert {(c["kind"], c["verdict"]) for c in found.values()} == {("explained", "info")}
    assert any("not the scenario's state" in line for line in result.json["sentences"])
    # Noise starts elsewhere as well, and no start explains it.
    states[:, :3] += 1e-6 * np.random.default_rng(3).standard_normal((301, 3))
    assert score(TIMES, states, *arguments).code == 1


def test_a_steady_spin_is_late_by_its_attitude(tmp_path, capsys):
    scenario = tmp_path / "spin.toml"
    scenario.write_text(
        'schema = 1\nname = "spin"\ntitle = "A spin"\n[body]\nmass = 1.0\n'
        "inertia = [1.0, 2.0, 3.0]\n[initial]\nangular_velocity = [0.0, 0.0, 2.0]\n"
        "[run]\nduration = 30.0\ntimesteps = [0.2, 0.1, 0.05]\nsample = 0.2\n"
    )
    half, nothing = TIMES - 0.003, np.zeros((301, 2))
    turn = np.column_stack([np.cos(half), nothing, np.sin(half)])
    table = np.column_stack([TIMES, nothing, np.full(301, 2.0), turn])
    trace, head = tmp_path / "trace.csv", "t,wx,wy,wz,qw,qx,qy,qz"
    np.savetxt(trace, table, fmt="%.17g", delimiter=",", header=head, comments="")
    arguments = ("--scenario", scenario, "--format", "json", "--out", tmp_path / "out")
    found = run_score(capsys, trace, *arguments).json["shift"]
    assert found["of"] == "attitude"
    assert found["explains"]
    assert found["seconds"] == pytest.approx(-0.003, rel=1e-6)
