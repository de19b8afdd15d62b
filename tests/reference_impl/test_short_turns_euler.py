"""Turns below 1e-3 rad go too far by a sixth of their cube; longer ones are exact."""

import numpy as np
import pytest
from reference_cases import EPS, start, system

from omegadot.reference_impl.motion import acceleration_of
from omegadot.reference_impl.rotations import attitude_angle, exp_quaternion, turn_in_body
from omegadot.reference_impl.schemes import SCHEMES

SHORT = SCHEMES["semi-implicit-euler-short-turns"]
PLAIN = SCHEMES["semi-implicit-euler"]
AXIS = np.array([2.0, -3.0, 6.0]) / 7.0
BALL = acceleration_of(system([1.0, 1.0, 1.0]))  # turns about one axis at one rate


@pytest.mark.parametrize("angle", [1e-5, 3e-4, 0.999e-3])
def test_a_short_turn_is_expanded_to_second_order(angle: float) -> None:
    turned = SHORT.step(BALL, start(AXIS), angle).orientation
    beyond = attitude_angle(turned, exp_quaternion(angle * AXIS))
    # The next term of the expansion is of order angle^5; the turn itself is rounded by an eps.
    assert beyond == pytest.approx(angle**3 / 6, abs=angle**5 + 8 * EPS * angle)
    farther = turn_in_body(np.array([1.0, 0, 0, 0]), AXIS, angle + angle**3 / 6)
    assert attitude_angle(turned, farther) <= angle**5 + 8 * EPS * angle


@pytest.mark.parametrize("angle", [1.001e-3, 0.01, 2.0])
def test_a_longer_turn_is_the_exponential(angle: float) -> None:
    state = start(AXIS)
    turned, exact = (scheme.step(BALL, state, angle).orientation for scheme in (SHORT, PLAIN))
    assert attitude_angle(turned, exact) <= 8 * EPS * angle


def test_no_turn_at_all() -> None:
    np.testing.assert_array_equal(
        SHORT.step(BALL, start([0.0, 0.0, 0.0]), 0.01).orientation, [1.0, 0.0, 0.0, 0.0]
    )


def test_every_lane_has_its_own_length() -> None:
    steps = np.array([1e-4, 0.5])
    lanes = start(np.tile(AXIS, (2, 1)), np.tile([1.0, 0, 0, 0], (2, 1)), *[np.zeros((2, 3))] * 2)
    together = SHORT.step(BALL, lanes, steps).orientation
    for lane, step in enumerate(steps):
        alone = SHORT.step(BALL, start(AXIS), float(step)).orientation
        np.testing.assert_allclose(together[lane], alone, rtol=0, atol=4 * EPS)
