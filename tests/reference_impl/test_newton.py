"""When the iteration of the midpoint rules ends, and what it makes of what does not settle."""

import numpy as np
import pytest

from omegadot.reference_impl.schemes.newton import mean_velocity_of
from omegadot.reference_impl.system import Acceleration

EYE, START = np.eye(3), np.array([1.0, -2.0, 0.5])


def solved(rate, noise=0.0):
    """ω_m for ``ω̇ = rate (ω - ω₀) + 1``, half a step of 1 s, the Jacobian taken for zero."""
    generator, requested = np.random.default_rng(0), []

    def evaluate(w, _):
        requested.append(w)
        jitter = noise * generator.standard_normal(3)
        return Acceleration(rate * (w - START) + 1.0 + jitter, np.zeros(3))

    first = Acceleration(np.ones(3), np.zeros(3))
    return mean_velocity_of(evaluate, first, START, 1.0, EYE)[0], len(requested)


@pytest.mark.parametrize("rate", [0.0, 0.1, -0.4, 0.6, -0.7])
def test_it_settles_where_changes_shrink_however_slowly(rate):
    found, requested = solved(rate)
    # Fifty changes, each `rate` of the one before, leave |rate|^50, below 2e-8.
    assert np.allclose(found, START + 1.0 / (1.0 - rate), rtol=1e-7)
    assert requested <= 50


@pytest.mark.parametrize("noise", [1e-12, 1e-7, 1e-4])
def test_noise_of_an_engine_ends_it_and_is_no_divergence(noise):
    found, requested = solved(0.1, noise)
    assert np.allclose(found, START + 1.0 / 0.9, atol=20 * noise)
    assert requested < 25


@pytest.mark.parametrize("rate", [1.0, -1.5, 3.0])
def test_what_does_not_settle_is_no_number(rate):
    assert np.isnan(solved(rate)[0]).all()


def test_lanes_settle_each_for_itself():
    rate = np.array([[0.1], [-2.0]])

    def evaluate(w, _):
        return Acceleration(rate * (w - START) + 1.0, np.zeros((2, 3)))

    first = Acceleration(np.ones((2, 3)), np.zeros((2, 3)))
    found, _ = mean_velocity_of(evaluate, first, np.array([START, START]), 1.0, EYE)
    assert np.allclose(found[0], START + 1.0 / 0.9)
    assert np.isnan(found[1]).all()
