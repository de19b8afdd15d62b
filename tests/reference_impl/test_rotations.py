"""Quaternions against matrices, the exponential (2.2) against SciPy, small angles kept."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from reference_cases import EPS, quaternions, vectors
from scipy.spatial.transform import Rotation

from omegadot.reference_impl.cross_product import skew
from omegadot.reference_impl.rotations import (
    attitude_angle,
    conjugate,
    exp_quaternion,
    normalize,
    quaternion_product,
    rotate,
    rotate_inverse,
    rotation_between,
    rotation_matrix,
    turn_in_body,
    turn_in_world,
)

few = settings(max_examples=50, derandomize=True, deadline=None)
# entries of a rotation are sums of up to four products of two rounded components
ROUNDING = 16 * EPS


@few
@given(quaternions)
def test_matrix_is_scipys_and_a_rotation(q: np.ndarray) -> None:
    R = rotation_matrix(q)
    assert np.max(np.abs(R - Rotation.from_quat(q[[1, 2, 3, 0]]).as_matrix())) <= ROUNDING
    assert np.max(np.abs(R @ R.T - np.eye(3))) <= ROUNDING
    assert abs(np.linalg.det(R) - 1) <= ROUNDING


@few
@given(quaternions, quaternions, vectors)
def test_product_is_composition(a: np.ndarray, b: np.ndarray, v: np.ndarray) -> None:
    bound = 4 * ROUNDING * max(1.0, np.linalg.norm(v))
    both = quaternion_product(a, b)
    assert np.max(np.abs(rotation_matrix(both) - rotation_matrix(a) @ rotation_matrix(b))) <= bound
    assert np.max(np.abs(rotate(both, v) - rotate(a, rotate(b, v)))) <= bound
    assert np.max(np.abs(rotate_inverse(a, rotate(a, v)) - v)) <= bound
    unit = quaternion_product(a, conjugate(a))
    assert np.max(np.abs(unit - [1, 0, 0, 0])) <= bound


@few
@given(vectors)
def test_exponential_is_scipys(r: np.ndarray) -> None:
    expected = Rotation.from_rotvec(r).as_matrix()
    assert np.max(np.abs(rotation_matrix(exp_quaternion(r)) - expected)) <= 2 * ROUNDING


@pytest.mark.parametrize("size", [0.0, 1e-300, 1e-40, 1e-19, 1e-17, 1e-12, 1e-9])
def test_exponential_of_a_small_turn_keeps_its_digits(size: float) -> None:
    r = size * np.array([0.6, 0.0, -0.8])
    q = exp_quaternion(r)
    assert q[0] == 1.0
    assert np.max(np.abs(q[1:] - r / 2)) <= 4 * EPS * size  # sin x = x below 1e-9


def test_exponential_of_a_small_turn_keeps_all_digits_of_long_double() -> None:
    # sin x = x (1 - x²/6), and x² at 1e-9 is below the last digit but not at 1e-8
    r = np.array([0.0, 1e-9, 0.0], np.longdouble)
    gap = np.abs(exp_quaternion(r)[1:] - r / 2)
    assert np.max(gap) <= 2 * np.finfo(np.longdouble).eps * r[1]


@few
@given(quaternions, vectors)
def test_body_form_is_the_world_form_of_the_turned_velocity(q: np.ndarray, w: np.ndarray) -> None:
    in_body, in_world = turn_in_body(q, w, 0.7), turn_in_world(q, rotate(q, w), 0.7)
    assert attitude_angle(in_body, in_world) <= 4 * ROUNDING * max(1.0, np.linalg.norm(w))


def test_quarter_turns_apply_in_the_right_order() -> None:
    # a quarter about z, then in the body about its own x, takes body z to the world's x
    quarter = np.pi / 2
    q = exp_quaternion(np.array([0.0, 0.0, quarter]))
    x = np.array([quarter, 0.0, 0.0])
    assert np.allclose(
        rotate(turn_in_body(q, x, 1.0), np.array([0, 0, 1.0])), [1, 0, 0], atol=1e-15
    )
    assert np.allclose(
        rotate(turn_in_world(q, x, 1.0), np.array([0, 0, 1.0])), [0, -1, 0], atol=1e-15
    )


def test_rate_of_the_matrix_is_matrix_times_skew() -> None:
    q, w, h = normalize(np.array([1.0, -2.0, 0.5, 3.0])), np.array([1.0, 2.0, -0.5]), 1e-5
    ahead, behind = (rotation_matrix(turn_in_body(q, w, t)) for t in (h, -h))
    # central difference: h^2 |w|^3 / 6 of curvature and eps / h of rounding
    bound = h**2 * np.linalg.norm(w) ** 3 / 6 + ROUNDING / h
    assert np.max(np.abs((ahead - behind) / (2 * h) - rotation_matrix(q) @ skew(w))) <= bound


@few
@given(quaternions, vectors)
def test_rotation_between_finds_the_turn(q: np.ndarray, r: np.ndarray) -> None:
    r = r / max(1.0, np.linalg.norm(r) / 3.0)  # below pi, where the turn is unique
    end = turn_in_body(q, r, 1.0)
    assert np.max(np.abs(rotation_between(q, end) - r)) <= 8 * ROUNDING
    assert np.max(np.abs(rotation_between(q, -end) - r)) <= 8 * ROUNDING
    assert abs(attitude_angle(q, end) - np.linalg.norm(r)) <= 8 * ROUNDING


@pytest.mark.parametrize("angle", [1e-14, 1e-12, 1e-8, 1e-3, 3.0])
def test_angle_is_resolved_down_to_rounding(angle: float) -> None:
    q = normalize(np.array([1.0, 2.0, 3.0, 4.0]))
    end = turn_in_body(q, np.array([0.0, angle, 0.0]), 1.0)
    assert abs(attitude_angle(q, end) - angle) <= 4 * EPS
    assert attitude_angle(q, -q) <= 2 * EPS


def test_extended_precision_and_leading_axes_are_kept() -> None:
    rng = np.random.default_rng(2)
    r = rng.normal(size=(6, 3))
    many = exp_quaternion(r)
    assert np.max(np.abs(many[3] - exp_quaternion(r[3]))) <= EPS
    long = exp_quaternion(r.astype(np.longdouble))
    assert long.dtype == np.longdouble
    assert np.max(np.abs(np.add.reduce(long**2, -1) - 1)) <= 4 * np.finfo(np.longdouble).eps
    assert rotation_matrix(long).dtype == rotate(long, r).dtype == np.longdouble


def test_many_rotations_are_found_each_for_itself() -> None:
    r = np.array([[0.1, 0.2, -0.3], [1.0, -1.0, 0.5], [-2.0, 0.3, 0.1]])
    q = exp_quaternion(np.array([[0.4, 0.0, 0.1], [1.0, 2.0, 0.0], [0.0, -0.7, 0.2]]))
    found = rotation_between(q, quaternion_product(q, exp_quaternion(r)))
    assert np.allclose(found, r, rtol=0, atol=64 * EPS)
