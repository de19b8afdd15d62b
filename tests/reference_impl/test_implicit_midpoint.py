"""The midpoint rule's own equation holds after a step, whatever way the body turns."""

import numpy as np
from reference_cases import EPS, start, system

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.motion import acceleration_of
from omegadot.reference_impl.schemes import SCHEMES

INERTIA = np.array([1.0, 2.0, 2.5])
MIDPOINT = SCHEMES["implicit-midpoint"]


def test_the_step_solves_its_equation() -> None:
    # Many lanes: in some the iteration ends on the same number, in some it alternates by an eps.
    w0, h = np.random.default_rng(1).normal(size=(2000, 3)), 0.05
    lanes = start(w0, np.tile([1.0, 0, 0, 0], (2000, 1)), *[np.zeros((2000, 3))] * 2)
    w1 = MIDPOINT.step(acceleration_of(system(INERTIA)), lanes, h).angular_velocity
    middle = 0.5 * (w0 + w1)
    residual = INERTIA * (w1 - w0) + h * cross(middle, INERTIA * middle)
    size = np.max(INERTIA) * np.linalg.norm(w0, axis=-1)
    assert np.all(np.linalg.norm(residual, axis=-1) <= 16 * EPS * size)


def test_a_step_that_is_too_large_is_no_number() -> None:
    w0 = np.array([70.0, 200.0, 110.0])
    found = MIDPOINT.step(acceleration_of(system(INERTIA)), start(w0), 5.0).angular_velocity
    assert np.all(np.isnan(found))
