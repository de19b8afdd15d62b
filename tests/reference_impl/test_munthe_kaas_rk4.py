"""Munthe-Kaas's Runge-Kutta with dexp⁻¹ in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from reference_cases import EPS, one_step, start, system

from omegadot.reference_impl.one_body.body_configurations import rate, rate_to_second_order
from omegadot.reference_impl.rotations import exp_quaternion, quaternion_product, rotation_between
from omegadot.reference_impl.schemes import SCHEMES


@pytest.mark.parametrize("angle", [0.0, 1e-20, 1e-8, 1e-4, 0.1, 1.0, 3.0])
def test_vector_rate_moves_the_exponential_with_omega(angle: float) -> None:
    """``exp(u + ε u̇) = exp(u) exp(ε ω)`` to first order in ε, by central differences."""
    u, w = angle * np.array([0.6, 0.0, 0.8]), np.array([1.0, -2.0, 0.5])
    moved, step = rate(u, w), 2.0**-17  # near the cube root of eps
    ahead, behind = exp_quaternion(u + step * moved), exp_quaternion(u - step * moved)
    turned = rotation_between(behind, ahead) / (2 * step)
    assert np.abs(turned - w).max() <= 64 * (step**2 + EPS / step)


def test_series_and_closed_form_part_at_the_fourth_power_of_the_angle() -> None:
    u, w = np.array([0.3, -0.2, 0.4]), np.array([1.0, -2.0, 0.5])
    gaps = [np.abs(rate(s * u, w) - rate_to_second_order(s * u, w)).max() for s in (1.0, 0.5)]
    assert abs(np.log2(gaps[0] / gaps[1]) - 4) < 0.1


def test_a_steady_spin_is_exact() -> None:
    of = system([1.0, 2.0, 3.0])
    begin = start([0.0, 0.0, 2.0], [1, 2, 3, 4])
    found = one_step(SCHEMES["munthe-kaas-rk4"], of, begin, 0.5)
    exact = quaternion_product(begin.orientation, exp_quaternion(0.5 * begin.angular_velocity))
    np.testing.assert_allclose(found.orientation, exact, rtol=0, atol=4 * EPS)
