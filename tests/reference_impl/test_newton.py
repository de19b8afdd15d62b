"""When the iteration of the midpoint rules ends, and what it makes of what does not settle."""

import numpy as np
import pytest

from omegadot.reference_impl.schemes.newton import mean_velocity_of

START = np.array([1.0, -2.0, 0.5])


def same(right):
    return right


def solved(rate, noise=0.0):
    """ω_m for ``ω̇ = rate (ω - ω₀) + 1``, half a step of 1 s, the Jacobian taken for zero."""
    generator, evaluated = np.random.default_rng(0), []

    def push(w):
        evaluated.append(w)
        jitter = noise * generator.standard_normal(3)
        return rate * (w - START) + 1.0 + jitter

    return mean_velocity_of(push, np.ones(3), START, same, slice(None), 0.5), len(evaluated)


@pytest.mark.parametrize("rate", [0.0, 0.1, -0.4, 0.6, -0.7])
def test_it_settles_where_changes_shrink_however_slowly(rate):
    found, evaluated = solved(rate)
    # Fifty changes, each `rate` of the one before, leave |rate|^50, below 2e-8.
    assert np.allclose(found, START + 1.0 / (1.0 - rate), rtol=1e-7)
    assert evaluated <= 50


@pytest.mark.parametrize("noise", [1e-12, 1e-7, 1e-4])
def test_noise_of_an_engine_ends_it_and_is_no_divergence(noise):
    found, evaluated = solved(0.1, noise)
    assert np.allclose(found, START + 1.0 / 0.9, atol=20 * noise)
    assert evaluated < 25


@pytest.mark.parametrize("rate", [1.0, -1.5, 3.0])
def test_what_does_not_settle_is_no_number(rate):
    assert np.isnan(solved(rate)[0]).all()


def test_lanes_settle_each_for_itself():
    rate = np.array([[0.1], [-2.0]])

    def push(w):
        return rate * (w - START) + 1.0

    starts = np.array([START, START])
    found = mean_velocity_of(push, np.ones((2, 3)), starts, same, slice(None), 0.5)
    assert np.allclose(found[0], START + 1.0 / 0.9)
    assert np.isnan(found[1]).all()


def test_only_the_spin_is_judged():
    """A linear velocity that is rounding alone around zero does not keep a step from settling."""
    generator = np.random.default_rng(1)

    def push(w):
        return np.concatenate((1e-20 * generator.standard_normal(3), 0.1 * (w[3:] - START) + 1.0))

    first, start = np.concatenate((np.zeros(3), np.ones(3))), np.concatenate((np.zeros(3), START))
    found = mean_velocity_of(push, first, start, same, slice(3, None), 0.5)
    assert np.allclose(found[3:], START + 1.0 / 0.9)
    assert np.all(np.abs(found[:3]) <= 1e-19)


@pytest.mark.parametrize(("noise", "settles"), [(1e-12, True), (1e-3, False)])
def test_a_spin_that_is_rounding_alone_is_at_rest(noise, settles):
    """Of a fast body at rest in attitude; that of an engine is ``eps m |v|² / J``."""
    generator = np.random.default_rng(2)

    def push(w):
        return np.concatenate((np.ones(3), noise * generator.standard_normal(3)))

    first, start = np.concatenate((np.ones(3), np.zeros(3))), np.concatenate((START, np.zeros(3)))
    found = mean_velocity_of(push, first, start, same, slice(3, None), 0.5)
    assert np.isfinite(found).all() == settles
    if settles:
        assert np.allclose(found[:3], START + 1.0)
        assert np.all(np.abs(found[3:]) <= 10 * noise)
    both = mean_velocity_of(
        push,
        np.array([first] * 2),
        np.array([start] * 2),
        same,
        slice(3, None),
        np.full((2, 1), 0.5),
    )
    assert np.isfinite(both).all() == settles


def test_velocities_that_settle_later_than_the_spin_are_waited_for():
    """In body axes a linear velocity is turned by the spin, and may settle long after it."""

    def push(w):
        return np.concatenate((0.4 * (w[:3] - START) + 1.0, np.zeros(3)))

    first, start = np.concatenate((np.ones(3), np.zeros(3))), np.concatenate((START, START))
    found = mean_velocity_of(push, first, start, same, slice(3, None), 0.5)
    assert np.allclose(found[:3], START + 1.0 / 0.6, rtol=1e-14, atol=0.0)


def test_a_spin_that_is_rounding_alone_settles_where_a_step_does_not_turn_by_it():
    """A body at rest whose engine finds an omega-dot of rounding, another one at each call."""
    generator = np.random.default_rng(2)

    def push(w):
        return 1e-14 * generator.standard_normal(w.shape)

    def settled(start, h):
        return np.isfinite(mean_velocity_of(push, push(start), start, same, slice(None), h)).all()

    assert settled(np.zeros(3), 1.0)
    assert settled(np.zeros((2, 3)), np.ones((2, 1)))
    assert not settled(np.zeros(3), 1e12)
