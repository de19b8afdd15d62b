"""Traces whose world turns, is turned or is shifted: found, and undone by the options advised."""

import shlex

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from score_line import BRICK, run_score, runge_kutta, tumble, turns

from omegadot.written import written

TIMES = 0.2 * np.arange(101)
MAPPED = ("--scenario", BRICK)
NAMES = "t,wx,wy,wz,qw,qx,qy,qz,px,py,pz,vx,vy,vz"
GRAVITY = 9.80665


@pytest.fixture
def score(tmp_path, capsys):
    def scored(states, *arguments, places=None, speeds=None, form="%.10g", mapped=MAPPED):
        parts = [TIMES, states, *(p for p in (places, speeds) if p is not None)]
        table = np.column_stack(parts)
        head = ",".join(NAMES.split(",")[: table.shape[1]])
        trace = tmp_path / "trace.csv"
        np.savetxt(trace, table, form, ",", header=head, comments="")
        out = ("--out", tmp_path / "out", "--format", "json")
        return run_score(capsys, trace, *mapped, *out, *arguments)

    return scored


def attitude(states, turn):
    return np.column_stack([states[:, :3], np.roll(turn.as_quat(), 1, axis=1)])


def advised(result):
    """The sentence about axes, and the option in it."""
    (line,) = [s for s in result.json["sentences"] if "; give --" in s or ": give --" in s]
    return line, shlex.split(line.partition("give ")[2].rstrip("."))


def passes(result, *channels):
    found = result.json["channels"]
    return {found[c]["kind"] for c in channels or found} == {"round-off"}


@pytest.mark.parametrize("rate", [[7.3e-5, 0.0, 0.0], [0.0, 0.0, -0.9], [0.01, 0.2, -0.1]])
def test_a_world_that_turns_is_found_and_undone(score, rate):
    exact = tumble(TIMES)
    seen = Rotation.from_rotvec(TIMES[:, None] * np.array(rate)).inv() * turns(exact)
    result = score(attitude(exact, seen))
    assert not passes(result, "attitude")
    line, options = advised(result)
    assert f"{written(np.linalg.norm(rate), 4)} rad/s about" in line
    assert score(attitude(exact, seen), *options).json["channels"]["attitude"]["max"] < 1e-8
    given = ",".join(map(repr, rate))
    assert passes(score(attitude(exact, seen), f"--world-rate={given}"))


def test_a_rate_that_changes_is_said_to(score):
    exact = tumble(TIMES)
    angle = 7.3e-5 * TIMES + 1e-10 * TIMES**3
    seen = Rotation.from_rotvec(angle[:, None] * [1.0, 0.0, 0.0]).inv() * turns(exact)
    line, options = advised(score(attitude(exact, seen)))
    assert "about x, a rate that changes a little" in line
    assert options[0].startswith("--world-rate=7.3")
    assert options[0].endswith(",0,0")
    # What the option leaves is no rate, and the advice ends.
    again = score(attitude(exact, seen), *options)
    left = float(line.rpartition("or by ")[2].split()[0])
    assert again.json["channels"]["attitude"]["max"] == pytest.approx(left, rel=1e-2)
    assert left > 100.0 * float(line.rpartition("and by ")[2].split()[0])
    assert not any("give --" in s for s in again.json["sentences"])


@pytest.mark.parametrize("side", ["world", "body"])
def test_axes_that_are_turned_are_found_and_undone(score, side):
    exact = tumble(TIMES)
    turn = Rotation.from_rotvec([0.1, -0.2, 0.3])
    if side == "world":
        states = attitude(exact, turn.inv() * turns(exact))
    else:
        states = attitude(exact, turns(exact) * turn)
        states[:, :3] = turn.inv().apply(exact[:, :3])
    line, options = advised(score(states))
    assert f"{side} axes are turned by 0.3742 rad" in line
    found = score(states, *options).json["channels"]
    assert max(found["attitude"]["max"], found["omega"]["max"]) < 1e-9


def test_an_integrator_s_error_is_no_turning_world(score):
    step, count = 0.2, 100
    states = runge_kutta(step, count)
    found = score(states)
    assert not any("axes" in s or "world turns" in s for s in found.json["sentences"])
    drifted = Rotation.from_rotvec(1e-3 * (TIMES + np.sin(TIMES))[:, None] * [1, 1, 0])
    found = score(attitude(tumble(TIMES), drifted * turns(tumble(TIMES))))
    assert not any("world turns" in s for s in found.json["sentences"])


def test_an_early_trace_in_a_turning_world_is_both(score):
    early = tumble(TIMES + 0.0005)
    early[0] = tumble(TIMES)[0]
    rate = np.array([7.3e-5, 0.0, 0.0])
    seen = Rotation.from_rotvec(TIMES[:, None] * rate).inv() * turns(early)
    found = score(attitude(early, seen))
    assert "from the second sample on; the first alone is on time" in found.json["shift"]["note"]
    assert found.json["shift"]["explains"]
    assert found.json["shift"]["after"] < 1e-9
    line, _ = advised(found)
    assert "turns at 7.3e-5 rad/s about x" in line


def test_the_first_samples_may_be_on_time(score):
    early = tumble(TIMES + 0.002)
    early[:4] = tumble(TIMES)[:4]
    found = score(early).json["shift"]
    assert found["explains"]
    assert found["note"].endswith("from the 5th sample on; those before are on time")
    assert found["seconds"] == pytest.approx(0.002, rel=1e-6)


THROWN = """schema = 1
name = "thrown"
title = "A thrown body, its mass off its origin"
[body]
mass = 2.0
inertia = [1.0, 2.0, 2.5]
center_of_mass = [0.1, -0.2, 0.3]
[initial]
angular_velocity = [0.3, 2.0, 0.1]
position = [1.0, 2.0, 3.0]
linear_velocity = [0.5, -1.0, 4.0]
[load]
gravity = [0.0, 0.0, -9.81]
[run]
duration = 20.0
timesteps = [0.02, 0.01, 0.005]
sample = 0.2
"""


@pytest.fixture
def thrown(tmp_path):
    from omegadot.commands.score.exact_trajectory import exact_trajectory
    from omegadot.commands.score.score import case_given

    path = tmp_path / "thrown.toml"
    path.write_text(THROWN)
    case = case_given(str(path))
    exact = exact_trajectory(case.system, case.initial)(TIMES)
    return ("--scenario", path), case, exact


def states_of(exact):
    return np.column_stack([exact.angular_velocity, exact.orientation])


def test_a_world_that_is_shifted_is_found_and_undone(score, thrown):
    mapped, _, exact = thrown
    places = exact.position + np.array([100.0, -5.0, 2.0])
    line, options = advised(score(states_of(exact), places=places, mapped=mapped))
    assert "shifted by (100, -5, 2) m" in line
    assert passes(score(states_of(exact), *options, places=places, mapped=mapped), "position")
    # Of the body's origin it is not a shift.
    c = Rotation.from_quat(np.roll(exact.orientation, -1, axis=1)).apply([0.1, -0.2, 0.3])
    result = score(states_of(exact), places=exact.position - c, mapped=mapped)
    assert "give --point origin" in advised(result)[0]
    options = ("--point", "origin")
    places = exact.position - c
    assert passes(score(states_of(exact), *options, places=places, mapped=mapped), "position")


def test_everything_is_read_in_a_world_that_turns_and_is_shifted(score, thrown):
    mapped, _, exact = thrown
    rate, origin = np.array([0.02, -0.1, 0.05]), np.array([10.0, 20.0, -30.0])
    back = Rotation.from_rotvec(TIMES[:, None] * rate).inv()
    turn = Rotation.from_quat(np.roll(exact.orientation, -1, axis=1))
    seen = attitude(states_of(exact), back * turn)
    seen[:, :3] = back.apply(turn.apply(exact.angular_velocity))
    places = back.apply(exact.position + origin)
    speeds = back.apply(exact.linear_velocity - np.cross(rate, exact.position + origin))
    options = ("--omega-frame", "world", "--world-rate=0.02,-0.1,0.05", "--world-origin=10,20,-30")
    found = score(seen, *options, places=places, speeds=speeds, mapped=mapped)
    assert passes(found)
    assert not found.json["not_given"]
    assert (
        "leave the velocity out"
        in score(
            np.delete(seen, np.s_[7:], axis=1), "--column", "v=wx,wy,wz", *options, mapped=mapped
        ).err
    )
    assert "write three numbers" in score(seen, "--world-rate", "1,2", mapped=mapped).err


@pytest.mark.parametrize("given", ["nothing", "position", "velocity", "both"])
def test_energy_without_a_velocity_is_that_of_the_rotation(score, thrown, given):
    """An offset of the position must not be weighed, nor a velocity be taken for granted."""
    mapped, _, exact = thrown
    wrong = exact.position + np.array([0.0, 0.0, 0.5])
    speeds = exact.linear_velocity * 1.001
    head = {"nothing": (None, None), "position": (wrong, None), "both": (exact.position, speeds)}
    if given == "velocity":  # with no position, its weight is not known
        table = np.column_stack([states_of(exact), speeds])
        result = score(table, "--column", "v=px,py,pz", "--column", "p=", mapped=mapped)
    else:
        places, moved = head[given]
        result = score(states_of(exact), places=places, speeds=moved, mapped=mapped)
    energy = result.json["channels"]["energy"]
    if given == "both":
        assert energy["max"] > 1e-4
        assert "rotation alone" not in energy["note"]
    else:
        assert energy["kind"] == "round-off"
        assert "of the rotation alone" in energy["note"]
