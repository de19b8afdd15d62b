"""The midpoint rule's own equation holds after a step, whatever way the body turns."""

from dataclasses import replace

import numpy as np
from reference_cases import EPS, one_step, start, system

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import Array

INERTIA = np.array([1.0, 2.0, 2.5])
MIDPOINT = SCHEMES["implicit-midpoint"]


def test_the_step_solves_its_equation() -> None:
    # Many lanes: in some the iteration ends on the same number, in some it alternates by an eps.
    w0, h = np.random.default_rng(1).normal(size=(2000, 3)), 0.05
    lanes = start(w0, np.tile([1.0, 0, 0, 0], (2000, 1)), *[np.zeros((2000, 3))] * 2)
    w1 = one_step(MIDPOINT, system(INERTIA), lanes, h).angular_velocity
    middle = 0.5 * (w0 + w1)
    residual = INERTIA * (w1 - w0) + h * cross(middle, INERTIA * middle)
    size = np.max(INERTIA) * np.linalg.norm(w0, axis=-1)
    assert np.all(np.linalg.norm(residual, axis=-1) <= 16 * EPS * size)


def test_a_step_that_is_too_large_is_no_number() -> None:
    w0 = np.array([70.0, 200.0, 110.0])
    found = one_step(MIDPOINT, system(INERTIA), start(w0), 5.0).angular_velocity
    assert np.all(np.isnan(found))


def test_forces_are_taken_where_the_middle_of_the_step_is() -> None:
    """Place and velocity there, for loads that depend on them: under a constant pull, exactly."""
    pull, h, of = np.array([0.5, -1.0, 2.0]), 0.3, system(INERTIA)
    evaluated = []

    def acceleration(q: Array, v: Array) -> Array:
        evaluated.append((q, v))
        return np.concatenate((0 * v[..., :3] + pull, -0.1 * v[..., 3:]), axis=-1)

    motion = replace(body_motion(of), acceleration=acceleration, jacobian=None)
    begin = start([1.0, 2.0, 3.0], position=[1.0, 2.0, 3.0], velocity=[-4.0, 5.0, 7.0])
    one_step(MIDPOINT, of, begin, h, motion=motion)
    velocity = begin.linear_velocity + 0.5 * h * pull
    place = begin.position + 0.5 * h * velocity
    q, v = evaluated[-1]
    np.testing.assert_allclose(v[:3], velocity, rtol=4 * EPS)
    np.testing.assert_allclose(q[:3], place, rtol=4 * EPS)
