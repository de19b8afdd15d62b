"""--detect finds the convention of a trace, states by how much, and never guesses."""

import shlex

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from score_line import BRICK, run_score, runge_kutta, tumble, turns, write_brick

TIMES = 0.2 * np.arange(76)
FLIP = Rotation.from_matrix(np.diag([1.0, -1.0, -1.0]))


def table(path, columns, names, form="%.12g"):
    np.savetxt(path, np.column_stack(columns), form, ",", header=",".join(names), comments="")
    return path


def detected(capsys, path, *arguments, scenario=BRICK):
    return run_score(capsys, path, "--scenario", scenario, "--detect", *arguments)


def scored(capsys, tmp_path, path, options):
    """The verdicts that the trace comes to with the options that were found."""
    arguments = [w for option in options for w in shlex.split(option)]
    out = tmp_path / "out"
    result = run_score(
        capsys, path, "--scenario", BRICK, *arguments, "--out", out, "--format", "json"
    )
    assert result.code == 0, result.err
    return {channel["verdict"] for channel in result.json["channels"].values()}


def body_rates_and_angles(states):
    return [np.rad2deg(states[:, :3]), turns(states).as_euler("ZYX", degrees=True)]


def world_rates_and_inverse(states):
    turn = turns(states)
    return [turn.apply(states[:, :3]), turn.inv().as_quat()]


def flipped(states):
    turn = FLIP.inv() * turns(states) * FLIP
    return [FLIP.inv().apply(states[:, :3]), np.roll(turn.as_quat(), 1, axis=1)]


def transposed(states):
    return [turns(states).as_matrix().transpose(0, 2, 1).reshape(-1, 9)]


def roll_first(states):
    return [turns(states).as_euler("xyz")[:, ::-1], states[:, 2::-1] * 30 / np.pi]


WAYS = {
    body_rates_and_angles: ["--rate-unit deg/s", "--angle-unit deg", "--euler ZYX"],
    world_rates_and_inverse: ["--omega-frame world", "--quaternion xyzw"],
    flipped: ["--world-axes=x,-y,-z", "--body-axes=x,-y,-z", "--quaternion wxyz"],
    transposed: ["--column 'r=C1,C2,C3,C4,C5,C6,C7,C8,C9'", "--attitude-is body-from-world"],
    roll_first: ["--rate-unit rpm", "--column 'w=C6,C5,C4'", "--euler ZYX"],
}


@pytest.mark.parametrize("way", WAYS, ids=lambda way: way.__name__)
def test_the_convention_is_found_and_scores_at_the_digits(capsys, tmp_path, way):
    columns = [1e3 * TIMES, *way(tumble(TIMES))]
    count = sum(c.shape[1] for c in columns[1:])
    names = ["clock", *(f"C{k}" for k in range(1, count + 1))]
    path = table(tmp_path / "trace.csv", columns, names)
    result = detected(capsys, path, "--format", "json")
    assert result.code == 0
    (found,) = result.json["fitting"]
    assert set(WAYS[way]) < set(found["options"])
    assert "--time-unit ms" in found["options"]
    assert result.json["runner_up"]["misfit"] > 1e6 * found["misfit"]
    assert scored(capsys, tmp_path, path, found["options"]) == {"pass"}


def test_an_erring_simulator_is_still_read(capsys, tmp_path):
    path = write_brick(tmp_path / "trace.csv", 0.5 * np.arange(51), runge_kutta(0.5, 50))
    result = detected(capsys, path)
    assert result.code == 0
    assert "--euler ZYX --angle-unit deg" in result.out
    assert "times as far off" in result.out
    assert [entry.name for entry in tmp_path.iterdir()] == ["trace.csv"]


def test_columns_that_are_named_are_the_only_ones_tried(capsys, tmp_path):
    states = tumble(TIMES)
    columns = [TIMES, states[:, 0], np.ones(len(TIMES)), states[:, 1:3], -TIMES]
    path = table(tmp_path / "trace.csv", columns, ["t", "wx", "one", "wy", "wz", "left"])
    assert detected(capsys, path).code == 1
    result = detected(capsys, path, "--column", "w=wx,wy,wz")
    assert result.code == 0
    assert "--column 'w=wx,wy,wz'" in result.out


def test_a_time_that_starts_elsewhere_is_an_offset(capsys, tmp_path):
    path = write_brick(tmp_path / "trace.csv", TIMES + 100.0, tumble(TIMES))
    assert "--time-offset 100.0" in detected(capsys, path).out


def test_a_body_that_has_not_turned_yet_is_ambiguous(capsys, tmp_path):
    times = np.linspace(0.0, 1e-4, 20)
    path = write_brick(tmp_path / "trace.csv", times, tumble(times), "%.6f")
    result = detected(capsys, path)
    assert result.code == 1
    assert "too little to distinguish them" in result.out


def test_equal_rates_about_all_axes_are_ambiguous(capsys, tmp_path):
    scenario = tmp_path / "ball.toml"
    scenario.write_text(
        'schema = 1\nname = "ball"\ntitle = "A ball"\n[body]\nmass = 1.0\n'
        "inertia = [1.0, 1.0, 1.0]\n[initial]\nangular_velocity = [0.5, 0.5, 0.5]\n"
        "[run]\nduration = 2.0\ntimesteps = [0.02, 0.01, 0.005]\nsample = 0.02\n"
    )
    times = np.linspace(0.0, 2.0, 21)
    spin = np.full((21, 3), 0.5)
    turn = Rotation.from_rotvec(times[:, None] * spin)
    columns = [times, spin, np.roll(turn.as_quat(), 1, axis=1)]
    names = ["t", "a", "b", "c", "k", "l", "m", "n"]
    path = table(tmp_path / "trace.csv", columns, names)
    result = detected(capsys, path, "--format", "json", scenario=str(scenario))
    assert result.code == 1
    assert result.json["ambiguous"]
    assert len(result.json["fitting"]) > 1


def test_another_motion_fits_nothing(capsys, tmp_path):
    states = tumble(TIMES)[::-1]
    path = write_brick(tmp_path / "trace.csv", TIMES, states)
    result = detected(capsys, path)
    assert result.code == 1
    assert "No convention that was tried fits" in result.out


def test_a_file_without_a_time_is_refused(capsys, tmp_path):
    path = table(tmp_path / "trace.csv", [np.sin(TIMES), np.cos(TIMES)], ["a", "b"])
    result = detected(capsys, path)
    assert result.code == 2
    assert "no column rises" in result.err


def test_what_fits_is_written_as_a_map_that_scores_alike(capsys, tmp_path):
    columns = [1e3 * TIMES, *body_rates_and_angles(tumble(TIMES))]
    path = table(tmp_path / "trace.csv", columns, ["clock", *(f"C {k}" for k in range(1, 7))])
    found = tmp_path / "found.toml"
    assert detected(capsys, path, "--out", found).code == 0
    line = (path, "--scenario", BRICK, "--map", found, "--out", tmp_path / "out")
    result = run_score(capsys, *line, "--format", "json")
    assert {channel["verdict"] for channel in result.json["channels"].values()} == {"pass"}
    assert detected(capsys, path, "--out", path).code == 2  # no file of ours is replaced
