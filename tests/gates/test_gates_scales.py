"""The sizes that errors are measured against, worked out by hand."""

from dataclasses import replace

import numpy as np
import pytest

from omegadot.gates.bounds.scales import (
    EPS,
    ROUNDINGS_PER_EVALUATION,
    ROUNDINGS_PER_STEP,
    angular_size,
    body_scale,
    linear_size,
    norm,
    omega_dot_bound,
    torque_size,
)
from omegadot.reference_impl.system import Acceleration, Body, Load, State, System

BODY = Body(np.array(2.0), np.array([0.0, 0.0, 2.0]), np.diag([2.0, 3.0, 4.0]))
LOAD = Load(gravity=np.array([0.0, 0.0, -10.0]), torque_body=np.array([0.0, 2.0, 0.0]))
FREE = System((BODY,), LOAD)
PIVOT = np.array([0.0, 3.0, 0.0])
PIVOTED = System((BODY,), Load(gravity=LOAD.gravity, pivot=PIVOT, damping=np.array(0.5)))
STATE = State(
    np.array([1.0, 0.0, 0.0, 0.0]),
    np.array([0.0, 0.0, 2.0]),
    np.zeros(3),
    np.array([0.0, 3.0, 4.0]),
)
ACCELERATION = Acceleration(np.array([3.0, 4.0, 0.0]), np.array([0.0, 0.0, 6.0]))


def test_the_counts_of_roundings() -> None:
    # Every bound is a multiple of these: to change one is to change what passes.
    assert (ROUNDINGS_PER_EVALUATION, ROUNDINGS_PER_STEP) == (64, 16)
    assert EPS == 2.0**-52


def test_a_length() -> None:
    np.testing.assert_array_equal(norm(np.array([[3.0, 4.0, 0.0], [0.0, 0.0, -2.0]])), [5.0, 2.0])


def test_a_free_body_is_measured_about_its_origin() -> None:
    scale = body_scale(FREE)
    assert (scale.mass, scale.lever) == (2.0, 2.0)
    assert scale.largest == pytest.approx(4.0 + 2.0 * 2.0**2, rel=4 * EPS)
    assert scale.smallest == pytest.approx(2.0, rel=4 * EPS)


def test_a_pivoted_body_is_measured_about_both_points() -> None:
    scale = body_scale(PIVOTED)
    assert scale.lever == 2.0 + 3.0
    assert scale.largest == pytest.approx(4.0 + 2.0 * 5.0**2, rel=4 * EPS)
    arm = np.array([0.0, -3.0, 2.0])
    about = np.diag([2.0, 3.0, 4.0]) + 2.0 * (13.0 * np.eye(3) - np.outer(arm, arm))
    assert scale.smallest == pytest.approx(np.linalg.eigvalsh(about)[0], rel=8 * EPS)


@pytest.mark.parametrize("eps", [EPS, 2.0**-23])
def test_an_ill_conditioned_inertia_widens_the_bound_of_omega_dot(eps: float) -> None:
    assert omega_dot_bound(FREE, eps) == pytest.approx(64 * eps * 12.0 / 2.0, rel=8 * EPS)


def test_the_terms_of_the_equation_add_up_by_size() -> None:
    gyroscopic, levers, moving = 12.0 * (4.0 + 5.0), 2.0 * 2.0 * (10.0 + 6.0), 2.0 * 5.0 * (5 + 4)
    expected = gyroscopic + 2.0 + levers + moving
    assert torque_size(FREE, STATE, ACCELERATION) == pytest.approx(expected, rel=8 * EPS)
    assert angular_size(FREE, STATE, ACCELERATION) == pytest.approx(expected / 2.0, rel=8 * EPS)


def test_a_lever_is_the_difference_of_two_places() -> None:
    """It is off by a rounding of the place, at which the force m (a - g) acts."""
    far = replace(STATE, position=np.array([0.0, 5.0, 12.0]))
    force = 2.0 * (6.0 + 10.0)
    there, here = torque_size(FREE, far, ACCELERATION), torque_size(FREE, STATE, ACCELERATION)
    assert there - here == pytest.approx(13.0 * force, rel=64 * EPS)
    falling = Acceleration(ACCELERATION.angular, LOAD.gravity)  # forward dynamics: no force
    assert torque_size(FREE, far, falling) == torque_size(FREE, STATE, falling)
    assert torque_size(PIVOTED, far, ACCELERATION) == torque_size(PIVOTED, STATE, ACCELERATION)


def test_a_pivoted_body_has_no_bias_of_translation() -> None:
    weight = np.linalg.norm(np.cross([0.0, -3.0, 2.0], [0.0, 0.0, -20.0])) + 0.5 * 2.0
    expected = 54.0 * (4.0 + 5.0) + weight + 2.0 * 5.0 * (10.0 + 6.0)
    assert torque_size(PIVOTED, STATE, ACCELERATION) == pytest.approx(expected, rel=16 * EPS)


def test_the_centre_of_mass_is_off_by_what_the_rotation_is() -> None:
    turning = float(angular_size(FREE, STATE, ACCELERATION))
    expected = 6.0 + 10.0 + 2.0 * (4.0 + turning) + 2.0 * 5.0
    assert linear_size(FREE, STATE, ACCELERATION) == pytest.approx(expected, rel=8 * EPS)


def test_a_lever_between_two_places_in_the_world_is_off_by_a_rounding_of_them() -> None:
    """Of a body at rest nothing else is left: what an engine adds there is rounding of rounding."""
    still = replace(STATE, angular_velocity=np.zeros(3), linear_velocity=np.array([0.0, 0.0, 1.0]))
    rest = Acceleration(np.zeros(3), np.zeros(3))
    weightless = System((replace(BODY, center_of_mass=np.zeros(3)),))
    turning = angular_size(weightless, still, rest)
    for place in (0.0, 400.0):
        there = replace(still, position=np.array([0.0, place, 0.0]))
        assert linear_size(weightless, there, rest) == EPS * place * turning
        assert linear_size(weightless, there, rest, 2.0**-23) == 2.0**-23 * place * turning
    assert turning > 0.0


def test_loads_that_cancel_count_each() -> None:
    """At its terminal rate a body has no torque left, but the roundings of damping and drive."""
    load = Load(damping=np.array(4.0), torque_world=np.array([0.0, 0.0, 12.0]))
    spinning = State(np.array([1.0, 0, 0, 0]), np.array([0, 0, 3.0]), np.zeros(3), np.zeros(3))
    still = Acceleration(np.zeros(3), np.zeros(3))
    ball = System((Body(np.array(1.0), np.zeros(3), 1e-3 * np.eye(3)),), load)
    size = float(torque_size(ball, spinning, still))
    assert size == pytest.approx(12.0 + 12.0 + 1e-3 * 9.0)
