"""Turns below 1e-3 rad go too far by a sixth of their cube; longer ones are exact."""

import numpy as np
import pytest
from reference_cases import EPS, one_step, start, system

from omegadot.reference_impl.rotations import (
    attitude_angle,
    exp_quaternion,
    rotation_matrix,
    turn_in_body,
)
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.schemes.short_turns_euler import quaternion_read

SHORT = SCHEMES["semi-implicit-euler-short-turns"]
PLAIN = SCHEMES["semi-implicit-euler"]
AXIS = np.array([2.0, -3.0, 6.0]) / 7.0
BALL = system([1.0, 1.0, 1.0])  # turns about one axis at one rate


@pytest.mark.parametrize("angle", [1e-5, 3e-4, 0.999e-3])
def test_a_short_turn_is_expanded_to_second_order(angle: float) -> None:
    turned = one_step(SHORT, BALL, start(AXIS), angle).orientation
    beyond = attitude_angle(turned, exp_quaternion(angle * AXIS))
    # What is off orthogonality moves what is read by as much, and the matrix is rounded.
    open_ = angle**4 / 4 + 8 * EPS
    assert beyond == pytest.approx(angle**3 / 6, abs=open_)
    farther = turn_in_body(np.array([1.0, 0, 0, 0]), AXIS, angle + angle**3 / 6)
    assert attitude_angle(turned, farther) <= open_


@pytest.mark.parametrize("turn", [0.3, 1.0, 2.0, 2.5, 3.1])
@pytest.mark.parametrize("axis", [[3.0, 1, -2], [-1, 3, 2], [1, -2, 3]])
def test_a_rotation_is_read_as_it_is(turn: float, axis: list[float]) -> None:
    q = exp_quaternion(turn * np.array(axis) / np.linalg.norm(axis))
    read = quaternion_read(rotation_matrix(q))
    assert read @ read == pytest.approx(1.0, abs=4 * EPS)
    assert attitude_angle(read, q) <= 16 * EPS


def test_what_is_no_rotation_is_read_by_one_row() -> None:
    """By the scalar's row where the trace is positive, else by that of the largest entry."""
    x, y, z = 1e-3, 2e-3, 3e-3
    stretched = np.eye(3) + np.array([[0.0, z, 0.0], [0.0, 0.0, x], [y, 0.0, 0.0]])
    expected = np.array([4.0, -x, -y, -z])  # (1 + tr, m21 - m12, m02 - m20, m10 - m01)
    np.testing.assert_allclose(quaternion_read(stretched), expected / np.linalg.norm(expected))
    half = np.diag([-1.0, 1.0, -1.0]) + np.array([[0.0, z, 0.0], [0.0, 0.0, x], [y, 0.0, 0.0]])
    expected = np.array([-y, z, 4.0, x])  # (m02 - m20, m10 + m01, 1 - m00 + m11 - m22, m21 + m12)
    np.testing.assert_allclose(quaternion_read(half), expected / np.linalg.norm(expected))


def test_the_sign_of_the_quaternion_goes_on() -> None:
    for sign in (1.0, -1.0):
        q = sign * np.array([0.1, -0.7, 0.5, 0.5])
        q /= np.linalg.norm(q)
        assert one_step(SHORT, BALL, start(AXIS, q), 1e-4).orientation @ q > 0.9


@pytest.mark.parametrize("angle", [1.001e-3, 0.01, 2.0])
def test_a_longer_turn_is_the_exponential(angle: float) -> None:
    state = start(AXIS)
    turned, exact = (one_step(scheme, BALL, state, angle).orientation for scheme in (SHORT, PLAIN))
    assert attitude_angle(turned, exact) <= 8 * EPS * angle


def test_no_turn_at_all() -> None:
    np.testing.assert_array_equal(
        one_step(SHORT, BALL, start([0.0, 0.0, 0.0]), 0.01).orientation, [1.0, 0.0, 0.0, 0.0]
    )


def test_every_lane_has_its_own_length() -> None:
    steps = np.array([1e-4, 0.5])
    lanes = start(np.tile(AXIS, (2, 1)), np.tile([1.0, 0, 0, 0], (2, 1)), *[np.zeros((2, 3))] * 2)
    together = one_step(SHORT, BALL, lanes, steps).orientation
    for lane, step in enumerate(steps):
        alone = one_step(SHORT, BALL, start(AXIS), float(step)).orientation
        np.testing.assert_allclose(together[lane], alone, rtol=0, atol=4 * EPS)
