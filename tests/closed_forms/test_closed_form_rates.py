"""Periods, flips, precession and nutation against the motions themselves, and what has none."""

from __future__ import annotations

import numpy as np
import pytest
from closed_form_cases import FREE, TOPS, Case, constants_for, flip_period
from closed_form_errors import EPS

from omegadot.reference_impl.closed_forms import closed_form_of, problem_of
from omegadot.reference_impl.closed_forms.digits import many_digits
from omegadot.reference_impl.closed_forms.free_rotation_motion import encircling_theta, mean_rate
from omegadot.reference_impl.closed_forms.lagrange_constants import nutation_of, top_of
from omegadot.reference_impl.rotations import rotate, rotation_between
from omegadot.reference_impl.system import Body, Load, State, System


def _named(name: str) -> Case:
    return next(case for case in FREE + TOPS if case.name == name)


def _precession_rate(case: Case) -> float:
    c = constants_for(case)
    assert c is not None
    with many_digits():
        return float(mean_rate(c, encircling_theta(c)))


@pytest.mark.parametrize(
    "name", ["about-least", "order-231", "near-middle", "full-tensor", "complement-1e-12"]
)
def test_period_and_precession(name: str) -> None:
    """After a period ω is back and the attitude has turned about H by rate times period."""
    case = _named(name)
    period = 2 * flip_period(case)
    state = closed_form_of(case.system, case.initial)(np.array([0.0, period]))
    first, last = state.angular_velocity
    # the period is rounded: ω moves by |dω/dt| T eps, at most by |ω|² T eps
    slack = 8 * EPS * (1 + np.linalg.norm(first) * period)
    assert np.linalg.norm(last - first) <= slack * np.linalg.norm(first)
    momentum = rotate(state.orientation[0], case.inertia @ first)
    q0 = state.orientation[0] * np.array([1.0, -1.0, -1.0, -1.0])
    q1 = state.orientation[1] * np.array([1.0, -1.0, -1.0, -1.0])
    turned = -rotation_between(q0, q1)  # q1 q0*, in the world
    angle = turned @ momentum / np.linalg.norm(momentum)
    excess = (angle - _precession_rate(case) * period) / (2 * np.pi)
    assert abs(excess - np.rint(excess)) <= slack
    assert np.linalg.norm(np.cross(turned, momentum)) <= slack * np.linalg.norm(momentum)


def test_flip_times() -> None:
    """The middle component of ω vanishes at the flips, changes its sign there and nowhere else."""
    case = _named("near-middle")
    c, period = constants_for(case), flip_period(case)
    first = float(-c.start / c.rate)
    flips = first + period * np.arange(np.ceil((-40 - first) / period), (60 - first) / period)
    motion = closed_form_of(case.system, case.initial)
    at = motion(flips).angular_velocity[:, 1]
    # a flip time of 60 s is rounded to 60 eps, ω_2 changes by less than |ω|² in a second
    assert np.all(np.abs(at) <= 100 * 4 * EPS * 4)
    dense = motion(np.linspace(-40.0, 60.0, 5001)).angular_velocity[:, 1]
    assert np.count_nonzero(np.diff(np.sign(dense))) == flips.size


def test_the_separatrix_and_constant_spin_have_no_period() -> None:
    critical = _named("separatrix")
    c = constants_for(critical)
    assert flip_period(critical) == np.inf
    flip = np.array([float(-c.start / c.rate)])
    w = closed_form_of(critical.system, critical.initial)(flip).angular_velocity[0]
    assert abs(w[1]) <= 8 * EPS * np.linalg.norm(w)
    for name in ("spin-least", "rest"):
        assert constants_for(_named(name)) is None


def test_symmetric_body_has_the_textbook_rates() -> None:
    """Oblate: ω goes round the axis at (I_3 - I_1) ω_3 / I_1, the axis round H at L / I_1."""
    case = _named("oblate")
    w = case.initial.angular_velocity
    c = constants_for(case)
    assert (c.turn, c.modulus.m1) == (1, 1)
    period = 2 * flip_period(case)
    np.testing.assert_allclose(period, 2 * np.pi / abs((2 - 1) * w[2] / 1), rtol=4 * EPS)
    # the mean of ψ, of which the body's own turn L/I_1 - (I_3 - I_1) ω_3 / I_1 is left
    momentum = np.linalg.norm(case.inertia @ w)
    np.testing.assert_allclose(_precession_rate(case), momentum - w[2], rtol=8 * EPS)


def test_top_nutates_in_its_period_between_its_cosines() -> None:
    for name in ("top", "loops", "tilted-gravity", "lever-along-x"):
        case = _named(name)
        numbers = problem_of(case.system, case.initial).numbers
        with many_digits():
            nutation = nutation_of(top_of(numbers[2:], *numbers[:2]))
            period = float(2 * nutation.modulus.quarter / nutation.rate)
        state = closed_form_of(case.system, case.initial)(np.linspace(0.0, period, 400))
        up = -np.array(case.gravity) / np.linalg.norm(case.gravity)
        lever = np.array(case.lever) / np.linalg.norm(case.lever)
        cosine = rotate(state.orientation, lever) @ up
        slack = 16 * EPS * (1 + np.linalg.norm(state.angular_velocity[0]) * period)
        assert abs(cosine[0] - cosine[-1]) <= slack
        assert float(nutation.roots[0]) - slack <= cosine.min()
        assert cosine.max() <= float(nutation.roots[1]) + slack


def test_no_top_without_symmetry() -> None:
    """A lever off the axis, or two moments an eps apart, leave the motion to the series."""
    gravity, lever = np.array([0.0, 0.0, -9.81]), np.array([0.0, 0.0, 0.3])
    initial = _named("top").initial
    for inertia, center in (
        (np.diag([1.0, 1.0, 0.5]), np.array([0.1, 0.0, 0.3])),
        (np.diag([1.0, 1.0 + EPS, 0.5]), lever),
    ):
        system = System(
            (Body(np.array(1.0), center, inertia),), Load(gravity=gravity, pivot=np.zeros(3))
        )
        assert closed_form_of(system, initial) is None


def test_many_bodies_at_once_are_refused() -> None:
    inertia = np.stack([np.eye(3), np.eye(3)])
    system = System((Body(np.ones(2), np.zeros((2, 3)), inertia),), Load())
    state = State(np.array([1.0, 0, 0, 0]), np.ones(3), np.zeros(3), np.zeros(3))
    with pytest.raises(ValueError, match="one body and one initial state"):
        closed_form_of(system, state)


def test_free_fall_and_pivot() -> None:
    """The centre of mass falls by g t²/2, or hangs on the pivot at the lever's end."""
    body = Body(np.array(2.0), np.array([0.1, 0.2, 0.3]), np.diag([1.0, 2.0, 3.0]))
    gravity = np.array([0.0, 0.5, -9.81])
    initial = State(
        np.array([1.0, 0, 0, 0]),
        np.array([0.3, 1.0, 0.1]),
        np.array([1.0, 2.0, 3.0]),
        np.array([-1.0, 0.5, 8.0]),
    )
    t = np.array([-1.5, 0.0, 2.0])
    falling = closed_form_of(System((body,), Load(gravity=gravity)), initial)(t)
    np.testing.assert_allclose(
        falling.position,
        initial.position + np.outer(t, initial.linear_velocity) + np.outer(t * t / 2, gravity),
        rtol=0,
        atol=16 * EPS * 40,
    )
    np.testing.assert_allclose(
        falling.linear_velocity, initial.linear_velocity + np.outer(t, gravity), atol=4 * EPS * 40
    )
    pivoted = closed_form_of(System((body,), Load(pivot=np.zeros(3))), initial)(t)
    lever = body.center_of_mass
    np.testing.assert_allclose(pivoted.position, rotate(pivoted.orientation, lever), atol=8 * EPS)
    held = closed_form_of(System((body,), Load(gravity=gravity, pivot=lever)), initial)(t)
    np.testing.assert_array_equal(held.position, np.zeros((3, 3)))
    np.testing.assert_array_equal(held.angular_velocity, falling.angular_velocity)
