"""One step of each scheme against its formula, written out with SciPy's rotations and tensors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from reference_cases import EPS, one_step, start, states, system, systems, turned
from scipy.spatial.transform import Rotation

from omegadot.reference_impl.coordinates import (
    COORDINATES,
    Coordinates,
    acceleration_in,
    to_coordinates,
)
from omegadot.reference_impl.cross_product import skew
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.one_body.body_configurations import (
    cayley,
    rate_to_second_order,
    retract_attitude,
)
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.rotations import rotation_matrix
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.schemes.jacobian import (
    acceleration_and_jacobian,
    solve_one_minus,
    solver_of_one_minus,
)
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
    return one_step(SCHEMES[name], on, initial, h)


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
    # the origin, off the centre of mass, accelerates with omega
    c = np.array([0.1, -0.2, 0.3])
    on = replace(DRIVEN, bodies=(replace(DRIVEN.body, center_of_mass=c),))
    w, R = INITIAL.angular_velocity, rotation_matrix(INITIAL.orientation)
    now, jacobian = forward_dynamics(on, INITIAL), analytic_jacobian(on, w)
    change = np.linalg.solve(np.eye(3) - H * jacobian, H * now.angular)
    push = now.linear - R @ (np.cross(now.angular, c) + np.cross(w, np.cross(w, c)))
    v0 = to_coordinates(on, INITIAL, "origin-world")[1][:3]
    end = one_step(SCHEMES["linearly-implicit-euler"], on, INITIAL, H, "origin-world")
    found = to_coordinates(on, end, "origin-world")[1][:3]
    expected = v0 + H * (push - R @ lever_slope(jacobian, w, c) @ change)
    assert np.max(np.abs(found - expected)) <= 256 * EPS * 10


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


def lever_slope(jacobian: Array, w: Array, c: Array) -> Array:
    """``∂(ω̇ × c + ω × (ω × c))/∂ω``, (3, 3)."""
    return -skew(c) @ jacobian - skew(np.cross(w, c)) - skew(w) @ skew(c)


@few
@given(systems(), states(), st.sampled_from(COORDINATES))
def test_jacobian_is_the_derivative(on: System, state: State, coordinates: Coordinates) -> None:
    state = place_on_pivot(on, state)
    q, v = to_coordinates(on, state, coordinates)
    found, jacobian = acceleration_and_jacobian(body_motion(on, coordinates), q, v)
    now = acceleration_in(on, state, forward_dynamics(on, state), coordinates)
    w, c, R = state.angular_velocity, on.body.center_of_mass, rotation_matrix(state.orientation)
    angular = analytic_jacobian(on, w)
    slope, nothing = lever_slope(angular, w, c), np.zeros((3, 3))
    expected = {
        "com-world": np.concatenate((nothing, angular)),
        "origin-world": np.concatenate((-R @ slope, angular)),
        "body-spatial": np.block([[-skew(w), skew(v[:3]) - slope], [nothing, angular]]),
    }[coordinates]
    expected = expected if on.load.pivot is None else angular
    # differences of accelerations at distance |ω|: their rounding over |ω|, times the condition
    size = max(np.max(np.abs(now)), float(w @ w), 1.0) * 100
    reach = float(np.linalg.norm(w)) or 1.0
    bound = 64 * EPS * np.linalg.cond(moving_inertia(on)) * size / reach
    assert jacobian.shape == expected.shape
    assert np.max(np.abs(jacobian - expected)) <= bound * (1 + np.linalg.norm(c))
    assert np.max(np.abs(found - now)) <= 64 * EPS * 100 * (1 + np.max(np.abs(now)))


@pytest.mark.parametrize(("n", "m"), [(3, 3), (6, 3), (6, 6), (2, 2)])
@pytest.mark.parametrize("lanes", [(), (4,)])
@pytest.mark.parametrize("dtype", [float, np.longdouble])
def test_one_minus_is_solved(n: int, m: int, lanes: tuple[int, ...], dtype: type) -> None:
    rng = np.random.default_rng(7)
    matrix = (0.3 * rng.normal(size=(*lanes, n, m))).astype(dtype)
    right = rng.normal(size=(*lanes, n)).astype(dtype)
    found = solve_one_minus(matrix, right)
    assert np.allclose(solver_of_one_minus(matrix)(right), found, rtol=1e-13)
    whole = np.concatenate((np.zeros((*lanes, n, n - m)), matrix), axis=-1)
    left = found - (whole @ found[..., None])[..., 0] - right
    condition = np.linalg.cond((np.eye(n) - whole).astype(float)).max()
    assert found.dtype == dtype
    assert np.max(np.abs(left)) <= 64 * np.finfo(dtype).eps * condition**2 * np.max(np.abs(found))


def test_what_has_no_solution_is_no_number() -> None:
    singular = np.array([np.eye(6), np.zeros((6, 6))])
    found = solver_of_one_minus(singular)(np.ones((2, 6)))
    assert np.all(np.isnan(found[0]))
    assert np.array_equal(found[1], np.ones(6))
    assert np.all(np.isnan(solve_one_minus(np.eye(6), np.ones(6))))


@pytest.mark.parametrize("turn", [0.0, 1e-9, 0.3, 2.0, 50.0])
def test_cayley_turns_by_twice_the_arctangent(turn: float) -> None:
    q = retract_attitude(np.array([1.0, 0, 0, 0]), cayley(np.array([0.0, turn, 0.0])))
    angle = 2 * np.arctan(turn / 2)
    assert np.max(np.abs(q - [np.cos(angle / 2), 0, np.sin(angle / 2), 0])) <= 4 * EPS


def test_vector_rate_keeps_the_exponential_turning_with_omega() -> None:
    # d/dt exp(u) = exp(u) ω_× by a central difference; the series of dexp⁻¹ stops before |u|⁴/720
    u, w, h = np.array([0.03, -0.02, 0.05]), np.array([1.0, 2.0, -1.5]), 1e-4
    rate = rate_to_second_order(u, w)
    slope = (expm(u + h * rate) - expm(u - h * rate)) / (2 * h)
    bound = (
        np.linalg.norm(u) ** 4 / 720 * np.linalg.norm(w) + h**2 * np.linalg.norm(w) ** 3 + EPS / h
    )
    assert np.max(np.abs(expm(u).T @ slope - skew(w))) <= bound
