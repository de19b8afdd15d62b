"""One step of each scheme against its formula, written out with SciPy's rotations and tensors."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from reference_cases import EPS, TOP, start, states, system, systems, turned
from scipy.spatial.transform import Rotation

from omegadot.reference_impl.cross_product import skew
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.motion import acceleration_of, forward_dynamics
from omegadot.reference_impl.rotations import rotation_matrix
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.schemes.implicit_midpoint import cayley
from omegadot.reference_impl.schemes.jacobian import (
    acceleration_and_jacobian,
    solve_one_minus,
)
from omegadot.reference_impl.schemes.lie_rk4 import vector_rate
from omegadot.reference_impl.system import Array, State, System

few = settings(max_examples=30, derandomize=True, deadline=None)
H = 0.05
DRIVEN = system(
    turned([1, 2, 2.5]),
    gravity=(0, 1, -9),
    damping=0.3,
    torque_body=(1, 0, 2),
    torque_world=(0, 2, 1),
)
INITIAL = start([1.0, 2.0, -3.0], [1, 2, 3, 4], (1, 2, 3), (0.5, -1, 2))


def expm(r: Array) -> Array:
    return Rotation.from_rotvec(r).as_matrix()


def stepped(name: str, on: System = DRIVEN, initial: State = INITIAL, h: float = H) -> State:
    return SCHEMES[name].step(acceleration_of(on), initial, h)


def analytic_jacobian(on: System, w: Array) -> Array:
    """``∂ω̇/∂ω = I⁻¹ ((I ω)_× - ω_× I - d)``: equation (8) differentiated by the rule (2)."""
    inertia = moving_inertia(on)
    return np.linalg.solve(
        inertia, skew(inertia @ w) - skew(w) @ inertia - on.load.damping * np.eye(3)
    )


def assert_state(found: State, R: Array, w: Array, v: Array, p: Array) -> None:
    assert np.max(np.abs(rotation_matrix(found.orientation) - R)) <= 64 * EPS
    assert np.max(np.abs(found.angular_velocity - w)) <= 64 * EPS * 4
    assert np.max(np.abs(found.linear_velocity - v)) <= 8 * EPS * 4
    assert np.max(np.abs(found.position - p)) <= 8 * EPS * 4


def test_semi_implicit_euler_uses_the_new_velocities() -> None:
    now = forward_dynamics(DRIVEN, INITIAL)
    w = INITIAL.angular_velocity + H * now.angular
    v = INITIAL.linear_velocity + H * DRIVEN.load.gravity
    R = rotation_matrix(INITIAL.orientation) @ expm(H * w)
    assert_state(stepped("semi-implicit-euler"), R, w, v, INITIAL.position + H * v)


def test_linearly_implicit_euler_solves_its_equation() -> None:
    now = forward_dynamics(DRIVEN, INITIAL)
    matrix = np.eye(3) - H * analytic_jacobian(DRIVEN, INITIAL.angular_velocity)
    w = INITIAL.angular_velocity + np.linalg.solve(matrix, H * now.angular)
    v = INITIAL.linear_velocity + H * DRIVEN.load.gravity
    R = rotation_matrix(INITIAL.orientation) @ expm(H * w)
    assert_state(stepped("linearly-implicit-euler"), R, w, v, INITIAL.position + H * v)


def test_linearly_implicit_euler_carries_the_change_of_omega_into_the_linear_velocity() -> None:
    # a pivoted body's centre of mass accelerates with omega
    initial = start([1.0, 2.0, -3.0], [1, 2, 3, 4], on=TOP)
    now = forward_dynamics(TOP, initial)
    w, r, R = initial.angular_velocity, lever(TOP), rotation_matrix(initial.orientation)
    jacobian = analytic_jacobian(TOP, w)
    change = np.linalg.solve(np.eye(3) - H * jacobian, H * now.angular)
    linear = R @ (-skew(r) @ jacobian - skew(np.cross(w, r)) - skew(w) @ skew(r))
    found = stepped("linearly-implicit-euler", TOP, initial)
    expected = initial.linear_velocity + H * (now.linear + linear @ change)
    assert np.max(np.abs(found.linear_velocity - expected)) <= 256 * EPS * 10


def test_naive_mean_takes_the_exponential_of_the_mean_velocity() -> None:
    # stages q_i = q0 exp(h a_i w_i-1), end q0 exp(h sum b_i w_i)
    def rate(R: Array, w: Array) -> Array:
        torque = R.T @ DRIVEN.load.torque_world + DRIVEN.load.torque_body - DRIVEN.load.damping * w
        inertia = DRIVEN.body.inertia
        return np.linalg.solve(inertia, torque - np.cross(w, inertia @ w))

    R0, w1 = rotation_matrix(INITIAL.orientation), INITIAL.angular_velocity
    a1 = rate(R0, w1)
    w2 = w1 + H / 2 * a1
    a2 = rate(R0 @ expm(H / 2 * w1), w2)
    w3 = w1 + H / 2 * a2
    a3 = rate(R0 @ expm(H / 2 * w2), w3)
    w4 = w1 + H * a3
    a4 = rate(R0 @ expm(H * w3), w4)
    R = R0 @ expm(H / 6 * (w1 + 2 * w2 + 2 * w3 + w4))
    w = w1 + H / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
    g = DRIVEN.load.gravity
    v = INITIAL.linear_velocity + H * g
    p = INITIAL.position + H * INITIAL.linear_velocity + H**2 / 2 * g
    assert_state(stepped("lie-rk4-naive"), R, w, v, p)


def test_rk4_on_the_quaternion_is_rk4_on_a_vector() -> None:
    # q' = Ω(ω) q / 2 with the 4x4 matrix Ω, forces at the direction of q; unit again at the end
    def rate(y: Array) -> Array:
        q, w = y[:4], y[4:]
        omega = np.block([[np.zeros((1, 1)), -w[None]], [w[:, None], -skew(w)]])
        unit = State(q / np.linalg.norm(q), w, INITIAL.position, INITIAL.linear_velocity)
        return np.concatenate((omega @ q / 2, forward_dynamics(DRIVEN, unit).angular))

    y = np.concatenate((INITIAL.orientation, INITIAL.angular_velocity))
    k1 = rate(y)
    k2 = rate(y + H / 2 * k1)
    k3 = rate(y + H / 2 * k2)
    k4 = rate(y + H * k3)
    end = y + H / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    found = stepped("rk4-quaternion")
    assert np.max(np.abs(found.orientation - end[:4] / np.linalg.norm(end[:4]))) <= 16 * EPS
    assert np.max(np.abs(found.angular_velocity - end[4:])) <= 64 * EPS * 4


def test_midpoint_satisfies_its_implicit_equation() -> None:
    end = stepped("implicit-midpoint")
    middle = (INITIAL.angular_velocity + end.angular_velocity) / 2
    half = skew(H / 2 * middle)
    turn = np.linalg.solve(np.eye(3) - half, np.eye(3) + half)  # Cayley's transform
    R0, R1 = rotation_matrix(INITIAL.orientation), rotation_matrix(end.orientation)
    assert np.max(np.abs(R1 - R0 @ turn)) <= 64 * EPS
    angle = Rotation.from_matrix(turn).as_rotvec() / 2
    halfway = Rotation.from_matrix(R0 @ expm(angle)).as_quat()[[3, 0, 1, 2]]
    stage = State(halfway, middle, INITIAL.position, INITIAL.linear_velocity)
    rate = forward_dynamics(DRIVEN, stage).angular
    gap = end.angular_velocity - INITIAL.angular_velocity - H * rate
    assert np.max(np.abs(gap)) <= 64 * EPS * 4
    v = INITIAL.linear_velocity + H * DRIVEN.load.gravity
    assert np.max(np.abs(end.linear_velocity - v)) <= 8 * EPS * 4
    mean = (INITIAL.linear_velocity + v) / 2
    assert np.max(np.abs(end.position - INITIAL.position - H * mean)) <= 8 * EPS * 4


@few
@given(systems(), states())
def test_jacobian_is_the_derivative(on: System, state: State) -> None:
    state = place_on_pivot(on, state)
    found, angular, linear = acceleration_and_jacobian(acceleration_of(on), state)
    now = forward_dynamics(on, state)
    w, r, R = state.angular_velocity, lever(on), rotation_matrix(state.orientation)
    jacobian = analytic_jacobian(on, w)
    a_w = R @ (-skew(r) @ jacobian - skew(np.cross(w, r)) - skew(w) @ skew(r))
    # differences of accelerations at distance |ω|: their rounding over |ω|, times the condition
    size = max(np.max(np.abs(now.angular)), float(w @ w), 1.0) * 100
    reach = max(np.linalg.norm(w), 0.0) or 1.0
    bound = 64 * EPS * np.linalg.cond(moving_inertia(on)) * size / reach
    assert np.max(np.abs(angular - jacobian)) <= bound
    assert np.max(np.abs(linear - a_w)) <= bound * (1 + np.linalg.norm(r))
    scale = np.max(np.abs(now.angular)) + np.max(np.abs(now.linear))
    assert np.max(np.abs(found.angular - now.angular)) <= 64 * EPS * 100 * (1 + scale)
    assert np.max(np.abs(found.linear - now.linear)) <= 64 * EPS * 100 * (1 + scale)


def test_one_minus_is_solved() -> None:
    rng = np.random.default_rng(7)
    matrix, right = 0.5 * rng.normal(size=(4, 3, 3)), rng.normal(size=(4, 3))
    found = solve_one_minus(matrix, right)
    expected = np.linalg.solve(np.eye(3) - matrix, right[..., None])[..., 0]
    condition = np.linalg.cond(np.eye(3) - matrix).max()
    assert np.max(np.abs(found - expected)) <= 64 * EPS * condition * np.max(np.abs(expected))


@pytest.mark.parametrize("turn", [0.0, 1e-9, 0.3, 2.0, 50.0])
def test_cayley_turns_by_twice_the_arctangent(turn: float) -> None:
    q = cayley(np.array([0.0, turn, 0.0]))
    angle = 2 * np.arctan(turn / 2)
    assert np.max(np.abs(q - [np.cos(angle / 2), 0, np.sin(angle / 2), 0])) <= 4 * EPS


def test_vector_rate_keeps_the_exponential_turning_with_omega() -> None:
    # d/dt exp(u) = exp(u) ω_× by a central difference; the series of dexp⁻¹ stops before |u|⁴/720
    u, w, h = np.array([0.03, -0.02, 0.05]), np.array([1.0, 2.0, -1.5]), 1e-4
    rate = vector_rate(u, w)
    slope = (expm(u + h * rate) - expm(u - h * rate)) / (2 * h)
    bound = (
        np.linalg.norm(u) ** 4 / 720 * np.linalg.norm(w) + h**2 * np.linalg.norm(w) ** 3 + EPS / h
    )
    assert np.max(np.abs(expm(u).T @ slope - skew(w))) <= bound
