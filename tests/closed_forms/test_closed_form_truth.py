"""Closed forms against fifty-digit truth over the whole grid, in units of the resolvable floor."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from closed_form_cases import FREE, TOPS, Case, flip_period
from closed_form_elliptic import free_rotation, nutation
from closed_form_errors import EPS, errors, stored_truth
from make_truth import series_of

from omegadot.reference_impl.closed_forms import closed_form_of, floor, problem_of
from omegadot.reference_impl.rotations import normalize, rotate
from omegadot.reference_impl.system import State

STORED = stored_truth()


def _solve(case: Case) -> State:
    motion = closed_form_of(case.system, case.initial)
    assert motion is not None
    return motion(np.array(case.times))


@pytest.mark.parametrize("case", FREE + TOPS, ids=lambda case: case.name)
def test_within_the_floor(case: Case) -> None:
    """Catches a wrong sign, a wrong branch, a lost period or a lost digit in any regime."""
    angle, speed = errors(_solve(case), STORED[case.name])
    resolvable = floor(case.system, case.initial, np.array(case.times))
    assert np.all(angle <= resolvable.attitude)
    assert np.all(speed <= resolvable.angular_velocity)


@pytest.mark.parametrize("case", FREE + TOPS, ids=lambda case: case.name)
def test_absolute_accuracy(case: Case) -> None:
    """The floor excuses nothing: with inputs taken as exact the forms are good to a few eps.

    An attitude comes of three products of quaternions and two small rotations, at most a rounding
    a component each: 16 eps. ω likewise, of its greatest size in the motion.
    """
    angle, speed = errors(_solve(case), STORED[case.name])
    greatest = max(float(mp.norm(mp.matrix(row[4:]))) for row in STORED[case.name])
    assert np.all(angle <= 16 * EPS)
    assert np.all(speed <= 4 * EPS * max(greatest, float(np.linalg.norm(case.omega))))


def test_stored_truth_is_the_series() -> None:
    """The file is what its script makes: checked afresh for the short cases."""
    for case in FREE + TOPS:
        if case.name in ("rest", "full-tensor-thin-bar", "van-zon-schofield"):
            with mp.workdps(50):
                fresh = series_of(case).states(case.orientation, case.omega, case.times)
                for row, stored in zip(fresh, STORED[case.name], strict=True):
                    for x, y in zip(row, stored, strict=True):
                        assert abs(x - y) <= mp.mpf(10) ** -28 * max(abs(x), 1)


def _has_textbook_form(case: Case) -> bool:
    distinct = len(np.unique(np.round(np.linalg.eigvalsh(case.inertia), 9))) == 3
    return distinct and bool(np.isfinite(flip_period(case)))


@pytest.mark.parametrize(
    "case", [case for case in FREE if _has_textbook_form(case)], ids=lambda case: case.name
)
def test_textbook_form_of_free_rotation(case: Case) -> None:
    """The Taylor series and mpmath's elliptic functions give one motion, to 25 digits.

    The stored truth has thirty; the division by sin of the nutation takes what is left.
    """
    with mp.workdps(60):
        found = free_rotation(case.inertia, case.orientation, case.omega, case.times)
        for (world_R_body, w), row in zip(found, STORED[case.name], strict=True):
            q = row[:4]
            for k in range(3):
                assert abs(w[k] - row[4 + k]) < mp.mpf(10) ** -25 * (1 + abs(w[k]))
            # R of q, its first column and its diagonal
            assert abs(world_R_body[1, 0] - 2 * (q[1] * q[2] + q[0] * q[3])) < mp.mpf(10) ** -25
            assert abs(world_R_body[2, 0] - 2 * (q[1] * q[3] - q[0] * q[2])) < mp.mpf(10) ** -25
            for i in range(3):
                diagonal = 2 * (q[0] ** 2 + q[1 + i] ** 2) - 1
                assert abs(world_R_body[i, i] - diagonal) < mp.mpf(10) ** -25


@pytest.mark.parametrize("off", [1e-8, 1e-9, 1e-12, 1e-40])
@pytest.mark.parametrize("axis", [0, 2])
def test_closer_to_an_axis_than_the_series_feel(axis: int, off: float) -> None:
    """ω goes round an ellipse, not a circle, however small it is; catches one taken for a top's."""
    omega = [1.7 * off, -off, 0.6 * off]
    omega[axis] = 1.3
    case = Case("close", np.diag([1.0, 2.0, 3.0]), tuple(omega), (0.3, 5.0, 12.0))
    with mp.workdps(120):
        motion = free_rotation(case.inertia, case.orientation, case.omega, case.times)
        truth = [[*_quaternion(world_R_body), *w] for world_R_body, w in motion]
    angle, speed = errors(_solve(case), truth)
    assert np.all(angle <= 16 * EPS)
    assert np.all(speed <= 4 * EPS * 1.3)


def _quaternion(matrix: mp.matrix) -> list[mp.mpf]:
    """Of a rotation by less than half a turn: q_0 from the trace, the rest from what is odd."""
    w = mp.sqrt(1 + matrix[0, 0] + matrix[1, 1] + matrix[2, 2]) / 2
    odd = [matrix[i - 1, i - 2] - matrix[i - 2, i - 1] for i in range(3)]
    return [w, *(x / (4 * w) for x in odd)]


@pytest.mark.parametrize("name", ["top", "no-spin", "cusps", "loops", "sphere-top", "low"])
def test_textbook_form_of_the_top(name: str) -> None:
    """Euler's angles by Legendre's integrals give the motion of the Taylor series."""
    case = next(case for case in TOPS if case.name == name)
    with mp.workdps(80):  # a start at a turning point costs half of the digits
        q0 = [mp.mpf(x) for x in case.orientation]
        q0 = [x / mp.norm(mp.matrix(q0)) for x in q0]
        cosine = q0[0] ** 2 - q0[1] ** 2
        transverse = mp.mpf(float(case.inertia[0][0])) + mp.mpf(case.lever[2]) ** 2
        axial, moment = mp.mpf(float(case.inertia[2][2])), -mp.mpf(case.lever[2]) * case.gravity[2]
        w = [mp.mpf(x) for x in case.omega]
        found = nutation(transverse, axial, moment, cosine, (w[0], w[1]), w[2], case.times)
        for (cosine_t, phi, psi), row in zip(found, STORED[name], strict=True):
            half = mp.acos(cosine_t) / 2
            expected = [
                mp.cos(half) * mp.cos((phi + psi) / 2),
                mp.sin(half) * mp.cos((phi - psi) / 2),
                mp.sin(half) * mp.sin((phi - psi) / 2),
                mp.cos(half) * mp.sin((phi + psi) / 2),
            ]
            sign = mp.sign(mp.fdot(expected, row[:4]))
            for x, y in zip(expected, row[:4], strict=True):
                assert abs(sign * x - y) < mp.mpf(10) ** -25


def test_every_case_has_the_form_it_should() -> None:
    assert all(problem_of(c.system, c.initial).kind == "free rotation" for c in FREE)
    assert all(problem_of(c.system, c.initial).kind == "Lagrange top" for c in TOPS)


def test_momentum_stays_over_a_thousand_periods() -> None:
    """|H| in the world to rounding at once: catches an ω out of phase with the attitude."""
    case = next(case for case in FREE if case.name == "near-middle")
    period = 2 * flip_period(case)
    state = closed_form_of(case.system, case.initial)(np.linspace(-1000, 1000, 4001) * period)
    momentum = rotate(state.orientation, state.angular_velocity @ case.inertia)
    first = rotate(
        normalize(case.initial.orientation), case.inertia @ case.initial.angular_velocity
    )
    error = np.linalg.norm(momentum - first, axis=-1)
    assert np.all(error <= 24 * EPS * np.linalg.norm(first))
