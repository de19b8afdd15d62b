"""Numbers for an attitude: they come back, move as it does, and are what they are called."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from reference_cases import DRIVEN, EPS, TOP, start

from omegadot.reference_impl.coordinates import to_coordinates
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.rotations import (
    attitude_angle,
    exp_quaternion,
    normalize,
    quaternion_product,
    rotate,
)
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.schemes.charts.chart import Chart
from omegadot.reference_impl.schemes.charts.rodrigues import RODRIGUES
from omegadot.reference_impl.schemes.charts.three_angles import MOST, ROLL_PITCH_YAW, TWO_FRAMES
from omegadot.reference_impl.schemes.charts.world_quaternion import WORLD_QUATERNION
from omegadot.reference_impl.schemes.charts.world_spatial import WORLD_SPATIAL
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, System

CHARTS = {
    "world-quaternion": WORLD_QUATERNION,
    "roll-pitch-yaw": ROLL_PITCH_YAW,
    "two-frames-xyz": TWO_FRAMES,
    "mrp": RODRIGUES,
    "world-spatial": WORLD_SPATIAL,
}
every_chart = pytest.mark.parametrize("name", sorted(CHARTS))
RNG = np.random.default_rng(20)
ATTITUDES = normalize(RNG.normal(size=(200, 4)))
X, Y, Z = np.eye(3)


def numbers_of(chart: Chart, q: Array) -> Array:
    return np.array(chart.of_quaternion(q.tolist()), float)


@every_chart
def test_an_attitude_comes_back_alone_and_among_lanes(name: str) -> None:
    chart = CHARTS[name]
    lanes = np.stack([*np.broadcast_arrays(*chart.of_quaternion([*ATTITUDES.T]))], -1)
    for q, lane in zip(ATTITUDES, lanes, strict=True):
        numbers = numbers_of(chart, q)
        assert len(numbers) == chart.count
        assert attitude_angle(np.array(chart.quaternion(numbers.tolist())), q) <= 32 * EPS
        assert attitude_angle(np.array(chart.quaternion(lane.tolist())), q) <= 32 * EPS


@pytest.mark.parametrize("name", ["roll-pitch-yaw", "two-frames-xyz"])
@pytest.mark.parametrize("away", [0.0, 1e-300, 1e-16, 1e-12, 1e-8, 1e-4, 0.1])
def test_angles_come_back_at_their_singularity_too(name: str, away: float) -> None:
    """Roll, pitch and yaw are singular where the body's x-axis is along the world's z-axis."""
    chart = CHARTS[name]
    for turn in RNG.uniform(-3, 3, (20, 2)):
        q = quaternion_product(exp_quaternion(turn[0] * Z), exp_quaternion((np.pi / 2 - away) * Y))
        q = quaternion_product(q, exp_quaternion(turn[1] * X))
        found = np.array(chart.quaternion(numbers_of(chart, q).tolist()))
        assert attitude_angle(found, q) <= 32 * EPS


@every_chart
def test_the_numbers_move_as_the_attitude_does(name: str) -> None:
    """By central differences, off the places where a number jumps and where angles are singular."""
    chart, w, step = CHARTS[name], np.array([1.0, -2.0, 0.5]), 2.0**-17
    shown = 0
    for q in ATTITUDES:
        numbers = numbers_of(chart, q)
        if name == "roll-pitch-yaw" and abs(np.cos(numbers[1])) < 0.5:
            continue
        spin = rotate(q, w) if chart.in_world else w
        rate = np.array(chart.rate(numbers.tolist(), spin.tolist()))
        ends = (quaternion_product(q, exp_quaternion(s * step * w)) for s in (1, -1))
        ahead, behind = (numbers_of(chart, end) for end in ends)
        if np.max(np.abs(ahead - behind)) > 0.1:
            continue
        shown += 1
        # third derivatives of numbers of size 1 under |w| = 2.3, in 0.5 of a singularity's distance
        bound = 2.3**3 * 2**4 * step**2 + 8 * EPS / step
        assert np.max(np.abs((ahead - behind) / (2 * step) - rate)) <= bound
    assert shown >= 100


def test_of_two_frames_neither_is_near_its_singularity() -> None:
    for q in normalize(np.random.default_rng(5).normal(size=(2000, 4))):
        numbers = numbers_of(TWO_FRAMES, q)
        assert abs(np.sin(numbers[1])) <= max(MOST, (1 - MOST**2) ** 0.5) + 8 * EPS


def test_roll_pitch_and_yaw_are_the_angles_of_their_name() -> None:
    """``R = Rz(yaw) Ry(pitch) Rx(roll)``: to constants yaw, pitch and minus roll."""
    none = numbers_of(ROLL_PITCH_YAW, np.array([1.0, 0, 0, 0]))
    for yaw, pitch, roll in ((0.3, 0, 0), (0, 0.3, 0), (0, 0, 0.3), (0.5, -0.4, 0.8)):
        q = quaternion_product(exp_quaternion(yaw * Z), exp_quaternion(pitch * Y))
        numbers = numbers_of(ROLL_PITCH_YAW, quaternion_product(q, exp_quaternion(roll * X)))
        assert np.max(np.abs((numbers - none)[:3] - [yaw, pitch, -roll])) <= 16 * EPS


@pytest.mark.parametrize("angle", [0.0, 1e-9, 3.0, np.pi - 1e-6, np.pi + 1e-6, 6.28])
def test_modified_rodrigues_parameters_are_those_of_the_shorter_turn(angle: float) -> None:
    axis = np.array([2.0, -1.0, 2.0]) / 3
    turn = angle if angle <= np.pi else angle - 2 * np.pi
    q = np.array([np.cos(angle / 2), *(np.sin(angle / 2) * axis)])
    assert np.max(np.abs(numbers_of(RODRIGUES, q) - np.tan(turn / 4) * axis)) <= 8 * EPS


def test_a_step_of_a_spatial_velocity_does_not_depend_on_where_the_world_begins() -> None:
    near = start([1.0, 2.0, -1.5], [1, 2, 3, 4], (1, 2, 3), (1, 2, 3))
    far = start([1.0, 2.0, -1.5], [1, 2, 3, 4], (2.0**20, 2, 3), (1, 2, 3))
    ends = [
        step_body(SCHEMES["rk4-world-spatial"], DRIVEN, one, 0.05, 5, 5)[1] for one in (near, far)
    ]
    for name in ("orientation", "angular_velocity", "linear_velocity"):
        one, other = (getattr(end, name)[-1] for end in ends)
        assert np.max(np.abs(one - other)) <= 64 * 2.0**20 * EPS


@pytest.mark.parametrize("on", [DRIVEN, TOP], ids=["free", "pivoted"])
@every_chart
def test_a_motion_of_arrays_is_stepped_as_one_of_components(name: str, on: System) -> None:
    motion = body_motion(on)
    arrays = replace(motion, acceleration=lambda q, v: np.array(motion.acceleration(q, v)))
    q, v = to_coordinates(on, start([1.0, 2.0, -1.5], [1, 2, 3, 4]), "com-world")
    scheme = next(one for key, one in SCHEMES.items() if key.endswith(name))
    for one, other in zip(
        scheme.step(motion, q, v, 0.1), scheme.step(arrays, q, v, 0.1), strict=True
    ):
        assert np.array_equal(one, other)


def test_the_page_of_formulas_has_every_scheme() -> None:
    """By its own name, or a method's and a chart's."""
    page = (Path(__file__).parents[2] / "docs" / "scheme-formulas.md").read_text(encoding="utf-8")
    for name in SCHEMES:
        chart = next((one for one in CHARTS if name.endswith(f"-{one}")), None)
        parts = [name] if chart is None else [name.removesuffix(f"-{chart}"), chart]
        assert all(f"`{part}`" in page for part in parts), name
