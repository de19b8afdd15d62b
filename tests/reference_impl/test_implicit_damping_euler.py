"""Semi-implicit Euler with implicit damping: what sets it apart from its neighbours."""

from __future__ import annotations

import numpy as np
from reference_cases import EPS, one_step, start, system

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.schemes import SCHEMES

STEP = SCHEMES["implicit-damping-euler"]
INERTIA = np.array([1.0, 2.0, 2.5])


def test_damping_is_implicit_and_the_gyroscopic_term_is_not() -> None:
    """``(I + h d) Δω = h (τ - ω × I ω - d ω)``, solved by hand in principal axes."""
    d, h, tau = 0.7, 0.3, np.array([1.0, -2.0, 0.5])
    of = system(INERTIA, damping=d, torque_body=tau)
    begin = start([2.0, 1.5, 1.0])
    w = begin.angular_velocity
    change = h * (tau - cross(w, INERTIA * w) - d * w) / (INERTIA + h * d)
    found = one_step(STEP, of, begin, h).angular_velocity
    np.testing.assert_allclose(found, w + change, rtol=64 * EPS)


def test_stiff_damping_is_stable() -> None:
    """A sphere: ``ω₁ = ω₀ / (1 + h d / I)``, where the explicit step would explode."""
    of = system([1.0, 1.0, 1.0], damping=1000.0)
    begin = start([2.0, 1.5, 1.0])
    found = one_step(STEP, of, begin, 0.1).angular_velocity
    np.testing.assert_allclose(found, begin.angular_velocity / 101.0, rtol=64 * 101 * EPS)


def test_without_damping_it_is_semi_implicit_euler() -> None:
    of = system(INERTIA, torque_world=[1.0, 0.0, 2.0])
    begin = start([2.0, 1.5, 1.0], [1, 2, 3, 4])
    found = one_step(STEP, of, begin, 0.1)
    plain = one_step(SCHEMES["semi-implicit-euler"], of, begin, 0.1)
    np.testing.assert_allclose(found.angular_velocity, plain.angular_velocity, rtol=64 * EPS)
    np.testing.assert_allclose(found.orientation, plain.orientation, rtol=64 * EPS)
