"""Spin about a fixed axis and the damped symmetric body against the Taylor series."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from closed_form_errors import EPS, errors
from closed_form_taylor import TaylorSeries

from omegadot.reference_impl.closed_forms import closed_form_of, floor, problem_of
from omegadot.reference_impl.rotations import attitude_angle, quaternion_product, rotate
from omegadot.reference_impl.solutions.exact_solution import exact_states
from omegadot.reference_impl.system import Body, Load, State, System

TIMES = np.array([0.0, 1e-3, 0.4, 3.0, 9.0])
Q = np.array([0.5, -0.5, 0.5, 0.5])


def _system(inertia: np.ndarray, **load: object) -> System:
    return System((Body(np.array(1.0), np.zeros(3), np.asarray(inertia, float)),), Load(**load))


def _state(omega: list[float]) -> State:
    return State(Q, np.array(omega), np.array([1.0, 2.0, 3.0]), np.array([0.1, 0.0, -0.2]))


@pytest.mark.parametrize(
    ("inertia", "omega"),
    [(np.diag([1.0, 2.0, 3.0]), [0.0, -1.3, 0.0]), (2.0 * np.eye(3), [0.4, -0.5, 0.6])],
    ids=["middle-axis", "sphere"],
)
@pytest.mark.parametrize("times", [TIMES, -0.3 * TIMES], ids=["forth", "back"])
def test_damped_spin(inertia: np.ndarray, omega: list[float], times: np.ndarray) -> None:
    system, initial = _system(inertia, damping=np.array(0.7)), _state(omega)
    assert problem_of(system, initial).kind == "fixed axis"
    with mp.workdps(50):
        truth = TaylorSeries(inertia.tolist(), 0.7).states(Q.tolist(), omega, times.tolist())
    state = closed_form_of(system, initial)(times)
    angle, speed = errors(state, truth)
    resolvable = floor(system, initial, times)
    assert np.all(angle <= resolvable.attitude)
    assert np.all(speed <= resolvable.angular_velocity)


@pytest.mark.parametrize("damping", [0.0, 1e-9, 0.5])
@pytest.mark.parametrize("frame", ["body", "world"])
def test_driven_spin(damping: float, frame: str) -> None:
    """ω solves ``I dω/dt = τ - d ω`` and the angle is its integral, by Gauss's quadrature."""
    axis = np.array([0.0, 1.0, 0.0])
    torque = -0.3 * axis
    world = rotate(Q, torque)  # a quarter turn: exact
    load = {"torque_body": torque} if frame == "body" else {"torque_world": world}
    system = _system(np.diag([1.0, 2.0, 3.0]), damping=np.array(damping), **load)
    motion = closed_form_of(system, _state([0.0, 1.1, 0.0]))
    nodes, weights = np.polynomial.legendre.leggauss(20)
    end = 3.0
    inner = motion(0.5 * end * (nodes + 1)).angular_velocity[:, 1]
    last = motion(np.array([end]))
    exact = (
        1.1 + end * -0.15
        if damping == 0
        else float(_exact_speed(mp.mpf("1.1"), mp.mpf("-0.3"), mp.mpf(damping), mp.mpf(2), end))
    )
    assert abs(last.angular_velocity[0, 1] - exact) <= 8 * EPS
    turned = 0.5 * end * float(weights @ inner)
    half = np.array([[np.cos(turned / 2), 0.0, np.sin(turned / 2), 0.0]])
    motionless = closed_form_of(system, _state([0.0, 1.1, 0.0]))(np.zeros(1)).orientation
    expected = quaternion_product(motionless[0], half[0])
    assert attitude_angle(expected, last.orientation[0]) <= 32 * EPS


def _exact_speed(w: mp.mpf, torque: mp.mpf, d: mp.mpf, i: mp.mpf, t: float) -> mp.mpf:
    with mp.workdps(40):
        decay = mp.exp(-d * t / i)
        return w * decay + torque / d * (1 - decay)


def test_axis_that_moves_has_no_fixed_axis_form() -> None:
    inertia = np.diag([1.0, 2.0, 3.0])
    assert problem_of(_system(inertia, damping=np.array(0.1)), _state([0.1, 1.0, 0.0])) is None
    sideways = _system(inertia, torque_body=np.array([0.0, 0.1, 0.0]))
    assert problem_of(sideways, _state([1.0, 0.0, 0.0])) is None
    assert closed_form_of(sideways, _state([1.0, 0.0, 0.0])) is None
    with pytest.raises(ValueError, match="no closed form"):
        floor(sideways, _state([1.0, 0.0, 0.0]), TIMES)


def test_rest_under_damping() -> None:
    system = _system(np.diag([1.0, 2.0, 3.0]), damping=np.array(0.1))
    state = closed_form_of(system, _state([0.0, 0.0, 0.0]))(TIMES)
    np.testing.assert_array_equal(state.angular_velocity, np.zeros((5, 3)))
    assert np.all(attitude_angle(Q, state.orientation) <= 4 * EPS)


@pytest.mark.parametrize("moments", [[1.0, 1.0, 2.0], [1.0, 2.0, 2.0], [2.0, 1.0, 2.0]])
def test_damped_symmetric_body(moments: list[float]) -> None:
    omega = [0.7, -1.1, 0.9]
    with mp.workdps(30):
        series = TaylorSeries(np.diag(moments).tolist(), 0.2)
        truth = series.states([1.0, 0.0, 0.0, 0.0], omega, TIMES.tolist())
    system = _system(np.diag(moments), damping=np.array(0.2))
    start = State(np.array([1.0, 0.0, 0.0, 0.0]), np.array(omega), np.zeros(3), np.zeros(3))
    source, found = exact_states(system, start, TIMES)
    assert source == "series"
    # the phase, up to |ω| t, and each factor are rounded a few times
    bound = 8 * EPS * (1 + np.linalg.norm(omega) * TIMES)
    exact = np.array([[float(x) for x in row[4:]] for row in truth])
    assert np.all(np.abs(found.angular_velocity - exact).max(-1) <= bound)
