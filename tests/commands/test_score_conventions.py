"""A motion written in any convention, declared, is at the floor; declared wrongly it is not."""

import json
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from score_line import run_score

from omegadot.commands.score.convention import axes_of
from omegadot.commands.score.exact_trajectory import exact_trajectory
from omegadot.commands.score.judged import judge_trace
from omegadot.commands.score.read_table import read_table
from omegadot.commands.score.score import case_given
from omegadot.commands.score.settings import reading_of

TUMBLE = """
schema = 1
name = "thrown"
title = "A thrown body, its mass off its origin"
[body]
mass = 2.0
inertia = [1.0, 2.0, 2.5]
center_of_mass = [0.1, -0.2, 0.3]
[initial]
orientation = [0.5, -0.5, 0.7, 0.1]
angular_velocity = [0.3, 2.0, 0.1]
position = [1.0, 2.0, 3.0]
linear_velocity = [0.5, -1.0, 4.0]
[load]
gravity = [0.0, 0.0, -9.81]
[run]
duration = 2.0
timesteps = [0.02, 0.01, 0.005]
sample = 0.02
"""
TIMES = np.sort(np.random.default_rng(1).uniform(0.0, 2.0, 25))
SEQUENCES = [a + b + c for a in "XYZ" for b in "XYZ" for c in "XYZ" if a != b != c]
AXES = ("x,y,z", "x,-y,-z", "y,x,-z", "-z,x,-y", "0.6,0,0.8,0")
SCALES = {
    "time": {"s": 1.0, "ms": 1e-3, "min": 60.0},
    "angle": {"rad": 1.0, "deg": np.pi / 180},
    "rate": {"rad/s": 1.0, "deg/s": np.pi / 180, "rpm": np.pi / 30},
    "length": {"m": 1.0, "ft": 0.3048, "mm": 1e-3},
}


@dataclass(frozen=True)
class Written:
    """A convention, as the options name it."""

    time: str
    angle: str
    rate: str
    length: str
    frame: str
    direction: str
    attitude: str  # wxyz, xyzw, matrix or a sequence
    point: str
    world: str
    body: str
    offset: float

    def options(self):
        settings = {
            "time-unit": self.time,
            "angle-unit": self.angle,
            "rate-unit": self.rate,
            "length-unit": self.length,
            "omega-frame": self.frame,
            "attitude-is": self.direction,
            "point": self.point,
            "world-axes": self.world,
            "body-axes": self.body,
            "time-offset": self.offset,
        }
        if self.attitude in ("wxyz", "xyzw"):
            settings["quaternion"] = self.attitude
        elif self.attitude != "matrix":
            settings["euler"] = self.attitude
        return settings

    def columns(self):
        group = {"wxyz": "q=A1,A2,A3,A4", "xyzw": "q=A1,A2,A3,A4"}
        group["matrix"] = "r=" + ",".join(f"A{k}" for k in range(1, 10))
        attitude = group.get(self.attitude, "e=A1,A2,A3")
        return ["t=T", "w=W1,W2,W3", attitude, "p=P1,P2,P3", "v=V1,V2,V3", "a=D1,D2,D3"]


CONVENTIONS = st.builds(
    Written,
    **{kind: st.sampled_from(sorted(units)) for kind, units in SCALES.items()},
    frame=st.sampled_from(["body", "world"]),
    direction=st.sampled_from(["world-from-body", "body-from-world"]),
    attitude=st.sampled_from(
        ["wxyz", "xyzw", "matrix", *SEQUENCES, *(s.lower() for s in SEQUENCES)]
    ),
    point=st.sampled_from(["center-of-mass", "origin"]),
    world=st.sampled_from(AXES),
    body=st.sampled_from(AXES),
    offset=st.sampled_from([0.0, 12.5]),
)


@pytest.fixture(scope="module")
def thrown(tmp_path_factory):
    """The scenario's file and the exact motion at the samples."""
    path = tmp_path_factory.mktemp("thrown") / "thrown.toml"
    path.write_text(TUMBLE)
    case = case_given(str(path))
    return path, case, exact_trajectory(case.system, case.initial)(TIMES)


def write(path, how, case, exact):
    """The exact motion in a convention, by SciPy alone."""
    world, body = (Rotation.from_matrix(axes_of(text, "")) for text in (how.world, how.body))
    turn = Rotation.from_quat(np.roll(exact.orientation, -1, axis=1))
    spin, spin_dot = exact.angular_velocity, acceleration(case, exact)
    place, speed = exact.position, exact.linear_velocity
    if how.point == "origin":
        c = case.system.body.center_of_mass
        place = place - turn.apply(c)
        speed = speed - turn.apply(np.cross(spin, c))
    theirs = world.inv() * turn * body
    if how.frame == "world":
        spins = [world.inv().apply(turn.apply(v)) for v in (spin, spin_dot)]
    else:
        spins = [body.inv().apply(v) for v in (spin, spin_dot)]
    moved = [world.inv().apply(v) / SCALES["length"][how.length] for v in (place, speed)]
    own = theirs if how.direction == "world-from-body" else theirs.inv()
    columns = {
        "T": (TIMES + how.offset) / SCALES["time"][how.time],
        "W": spins[0] / SCALES["rate"][how.rate],
        "D": spins[1] / SCALES["rate"][how.rate],
        "A": attitude_numbers(own, how),
        "P": moved[0],
        "V": moved[1],
    }
    names, parts = [], []
    for name, values in columns.items():
        many = values.reshape(len(TIMES), -1).T
        names += [f"{name}{k}" for k in range(1, len(many) + 1)] if len(many) > 1 else [name]
        parts += list(many)
    header = ",".join(names)
    np.savetxt(path, np.array(parts).T, "%.17g", ",", header=header, comments="")


def attitude_numbers(turn, how):
    if how.attitude == "wxyz":
        return np.roll(turn.as_quat(), 1, axis=1)
    if how.attitude == "xyzw":
        return turn.as_quat()
    if how.attitude == "matrix":
        return turn.as_matrix().reshape(-1, 9)
    return turn.as_euler(how.attitude) / SCALES["angle"][how.angle]


def acceleration(case, exact):
    inertia = case.system.body.inertia
    spin = exact.angular_velocity
    return np.linalg.solve(inertia, -np.cross(spin, spin @ inertia.T).T).T


@given(how=CONVENTIONS)
@settings(max_examples=40, derandomize=True, deadline=None)
def test_every_convention_is_read_to_the_floor(thrown, tmp_path_factory, how):
    _, case, exact = thrown
    path = tmp_path_factory.getbasetemp() / "written.csv"
    write(path, how, case, exact)
    reading = reading_of(read_table(path), how.columns(), None, how.options())
    found = judge_trace(case, reading)
    for channel, error in found.error.items():
        assert np.max(error - found.bound[channel]) <= 0.0, channel
    assert not found.absent


WRONG = {
    "frame": "world",
    "direction": "body-from-world",
    "attitude": "xyz",
    "point": "origin",
    "world": "x,-y,-z",
    "body": "x,-y,-z",
}
RIGHT = Written(
    "s", "deg", "deg/s", "ft", "body", "world-from-body", "ZYX", "center-of-mass",
    "x,y,z", "x,y,z", 0.0,
)  # fmt: skip


@pytest.mark.parametrize("part", WRONG)
def test_a_wrong_declaration_is_not_at_the_floor(thrown, tmp_path, part):
    _, case, exact = thrown
    path = tmp_path / "written.csv"
    write(path, RIGHT, case, exact)
    wrong = Written(**{**vars(RIGHT), part: WRONG[part]})
    reading = reading_of(read_table(path), wrong.columns(), None, wrong.options())
    found = judge_trace(case, reading)
    assert any(np.max(e) > 1e-3 for e in found.error.values())


def test_a_map_equals_the_options_and_these_come_first(thrown, tmp_path, capsys):
    scenario, case, exact = thrown
    path, mapped = tmp_path / "written.csv", tmp_path / "map.toml"
    write(path, RIGHT, case, exact)
    mapped.write_text(
        """
        angle-unit = "deg"
        rate-unit = "rpm"
        length-unit = "ft"
        euler = "ZYX"
        [columns]
        t = "T"
        w = ["W1", "W2", "W3"]
        e = ["A1", "A2", "A3"]
        px = "P1"
        py = "P2"
        pz = "P3"
        """
    )
    arguments = (
        "--scenario",
        scenario,
        "--map",
        mapped,
        "--rate-unit",
        "deg/s",
        "--format",
        "json",
    )
    result = run_score(capsys, path, *arguments, "--out", tmp_path / "out")
    assert result.code == 0, result.err
    channels = json.loads(result.out)["channels"]
    assert {"omega", "attitude", "position"} <= set(channels)
    assert {channel["verdict"] for channel in channels.values()} == {"pass"}


def test_single_precision_columns_are_bounded_by_their_own_digits(thrown, tmp_path, capsys):
    import polars as pl

    scenario, case, exact = thrown
    csv_file, path = tmp_path / "written.csv", tmp_path / "written.parquet"
    write(csv_file, RIGHT, case, exact)
    frame = pl.read_csv(csv_file)
    frame.with_columns(pl.all().exclude("T").cast(pl.Float32)).write_parquet(path)
    options = [w for c in RIGHT.columns() for w in ("--column", c)]
    options += [w for k, v in RIGHT.options().items() for w in (f"--{k}={v}",)]
    arguments = ("--scenario", scenario, *options, "--format", "json", "--out", tmp_path / "out")
    result = run_score(capsys, path, *arguments)
    assert result.code == 0, result.err
    found = json.loads(result.out)["channels"]
    assert {channel["verdict"] for channel in found.values()} == {"pass"}
    assert found["omega"]["max"] > 1e-9
