"""Equations (7) to (9) by three independent routes: particles, momentum in the world, Lagrange."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from reference_cases import (
    DAMPED,
    DRIVEN,
    EPS,
    FREE,
    TOP,
    cloud,
    pivots,
    rows,
    seeds,
    start,
    states,
    system,
    systems,
    turned,
    vectors,
)

from omegadot.reference_impl.arithmetic.precision import extended, to_double
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.loads import (
    applied_torque,
    damping_torque,
    gravity_torque,
    torque,
    weight,
)
from omegadot.reference_impl.momentum import angular_momentum
from omegadot.reference_impl.motion import (
    acceleration_of,
    angular_acceleration,
    forward_dynamics,
    inverse_dynamics,
    torque_for,
    torque_free_angular_acceleration,
)
from omegadot.reference_impl.rotations import rotate, rotate_inverse, turn_in_body
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array, Load, State, System

few = settings(max_examples=40, derandomize=True, deadline=None)
AccelerationAt = Callable[[System, State], Acceleration]


def wrong_sign(system: System, state: State) -> Acceleration:
    """Equation (9) as it is printed: the gyroscopic term with a plus."""
    w, inertia = state.angular_velocity, moving_inertia(system)
    tau = torque(system, state) + cross(w, apply(inertia, w))
    right = forward_dynamics(system, state)
    return replace(right, angular=apply(inverse(inertia), tau))


def excess_over_particles(
    dynamics: AccelerationAt, seed: int, pivot: Array | None, s: State
) -> float:
    """How far d'Alembert's sum over the particles is off, in units of its rounding.

    Each particle has ``a = R (ω̇ × r + ω × (ω × r)) + ẍ``, the derivative of (3); the moments of
    ``m (a - g)`` about the fixed point must add up to nothing, and their forces too when free.
    """
    system, masses, r = cloud(seed, pivot)
    s = replace(s, orientation=np.array([1.0, 0.0, 0.0, 0.0]))
    found = dynamics(system, s)
    w = s.angular_velocity
    a = np.cross(found.angular, r) + np.cross(w, np.cross(w, r)) + found.linear
    force = masses[:, None] * (a - system.load.gravity)
    arm = r + lever(system)
    moment = np.sum(np.cross(arm, force), axis=0)
    # a and g may cancel, and leave their roundings.
    sizes = masses * (np.linalg.norm(a, axis=-1) + np.linalg.norm(system.load.gravity))
    size = np.sum(np.linalg.norm(arm, axis=-1) * sizes)
    condition = np.linalg.cond(moving_inertia(system))
    excess = np.max(np.abs(moment)) / (EPS * condition * size + 1e-300)
    if pivot is None:
        total = np.max(np.abs(np.sum(force, axis=0)))
        excess = max(excess, total / (EPS * np.sum(sizes) + 1e-300))
    return float(excess)


@few
@given(seeds, pivots, states())
def test_forces_on_the_particles_add_up(seed: int, pivot: Array | None, state: State) -> None:
    # about forty roundings on the way from the state to a moment
    assert excess_over_particles(forward_dynamics, seed, pivot, state) <= 64


@pytest.mark.parametrize("pivot", [None, np.array([0.3, 0.2, -0.5])])
def test_wrong_sign_of_the_gyroscopic_term_is_caught(pivot: Array | None) -> None:
    state = start([1.0, 2.0, -0.5])
    assert excess_over_particles(forward_dynamics, 3, pivot, state) <= 64
    assert excess_over_particles(wrong_sign, 3, pivot, state) > 1e12


def rate_of_momentum(system: System, state: State, found: Acceleration) -> tuple[Array, float]:
    """The derivative of ``R I ω`` in the world by a central difference, and its error's bound."""
    h = 1e-5

    def momentum(t: float) -> Array:
        w = state.angular_velocity + t * found.angular
        middle = state.angular_velocity + t * found.angular / 2
        turned = turn_in_body(state.orientation, middle, t)
        return angular_momentum(system, replace(state, orientation=turned, angular_velocity=w))

    rate = np.linalg.norm(state.angular_velocity) + np.sqrt(np.linalg.norm(found.angular)) + 1
    inertia = np.linalg.norm(moving_inertia(system))
    # third derivatives of R and ω stay below (2 rate)^4; rounding: a few eps of the momentum
    bound = h**2 * inertia * (2 * rate) ** 4 + 32 * EPS * inertia * rate / h
    return (momentum(h) - momentum(-h)) / (2 * h), float(bound)


@few
@given(systems(), states())
def test_momentum_in_the_world_changes_by_the_torque(system: System, state: State) -> None:
    found = forward_dynamics(system, state)
    rate, bound = rate_of_momentum(system, state, found)
    expected = rotate(state.orientation, torque(system, state))
    assert np.max(np.abs(rate - expected)) <= bound


def _lagrange(system: System, angles: list[float], rates: list[float]) -> list[mp.mpf]:
    """ω̇ of a pivoted body from its Lagrangian in Euler angles zxz, all by numeric derivatives."""
    inertia = mp.matrix(to_double(moving_inertia(extended(system))).tolist())
    arm = mp.matrix(lever(system).tolist())
    weight = mp.matrix((system.body.mass * system.load.gravity).tolist())

    def about(axis: int, a: mp.mpf) -> mp.matrix:
        R, i, j = mp.eye(3), (axis + 1) % 3, (axis + 2) % 3
        R[i, i] = R[j, j] = mp.cos(a)
        R[i, j], R[j, i] = -mp.sin(a), mp.sin(a)
        return R

    def omega(q: list[mp.mpf], v: list[mp.mpf]) -> mp.matrix:
        unit = mp.matrix([0, 0, 1])
        spin = about(2, q[2]).T
        nod = spin * mp.matrix([1, 0, 0])
        return v[2] * unit + v[1] * nod + v[0] * (spin * about(0, q[1]).T * unit)

    def lagrangian(*x: mp.mpf) -> mp.mpf:
        q, v = list(x[:3]), list(x[3:])
        w = omega(q, v)
        R = about(2, q[0]) * about(0, q[1]) * about(2, q[2])
        return (w.T * inertia * w)[0] / 2 + (weight.T * (R * arm))[0]

    x = [mp.mpf(a) for a in angles + rates]

    def derivative(*which: int) -> mp.mpf:
        return mp.diff(lagrangian, x, tuple(which.count(i) for i in range(6)))

    mass = mp.matrix(3, 3)
    force = mp.matrix(3, 1)
    for i in range(3):
        force[i] = derivative(i) - mp.fsum(derivative(3 + i, j) * x[3 + j] for j in range(3))
        for j in range(3):
            mass[i, j] = derivative(3 + i, 3 + j)
    a = mp.lu_solve(mass, force)

    def along(t: mp.mpf, i: int) -> mp.mpf:
        q = [x[k] + t * x[3 + k] + t * t * a[k] / 2 for k in range(3)]
        return omega(q, [x[3 + k] + t * a[k] for k in range(3)])[i]

    return [mp.diff(lambda t, i=i: along(t, i), 0) for i in range(3)]


def test_lagranges_equations_give_the_same_omega_dot() -> None:
    angles, rates = [0.3, 0.9, -0.7], [1.2, -0.4, 2.0]
    phi, theta, psi = angles
    body = system(
        turned([0.4, 0.5, 0.7]), 1.5, (0.02, 0.01, 0.2), pivot=(0, 0, 0), gravity=(0, 1, -9)
    )
    with mp.workdps(40):
        expected = np.array([float(x) for x in _lagrange(body, angles, rates)])
    q = start([0, 0, 0]).orientation
    for axis, angle in ((2, phi), (0, theta), (2, psi)):
        q = turn_in_body(q, np.eye(3)[axis] * angle, 1.0)
    s, c = np.sin(theta), np.cos(theta)
    w = np.array(
        [
            rates[0] * s * np.sin(psi) + rates[1] * np.cos(psi),
            rates[0] * s * np.cos(psi) - rates[1] * np.sin(psi),
            rates[0] * c + rates[2],
        ]
    )
    state = start(w, q, on=body)
    condition = np.linalg.cond(moving_inertia(body))
    bound = 64 * EPS * condition * np.max(np.abs(expected))
    assert np.max(np.abs(forward_dynamics(body, state).angular - expected)) <= bound
    assert np.max(np.abs(wrong_sign(body, state).angular - expected)) > 0.1


@few
@given(systems(), states())
def test_inverse_dynamics_returns_the_torques(system: System, state: State) -> None:
    tau = inverse_dynamics(system, state, forward_dynamics(system, state))
    expected = damping_torque(system, state) + applied_torque(system, state)
    inertia, w = moving_inertia(system), state.angular_velocity
    parts = (torque(system, state), gravity_torque(system, state), cross(w, apply(inertia, w)))
    size = sum(np.linalg.norm(part) for part in parts) + 1e-300
    bound = 64 * EPS * np.linalg.cond(inertia) * size
    assert np.max(np.abs(tau - expected)) <= bound


@few
@given(systems(), states())
def test_extended_precision_agrees_within_the_condition_number(
    system: System, state: State
) -> None:
    found = forward_dynamics(system, state)
    long = forward_dynamics(extended(system), extended(state))
    inertia, w = moving_inertia(system), state.angular_velocity
    norm = np.linalg.norm
    pull = norm(weight(system)) * norm(lever(system)) + norm(system.load.torque_world)
    push = pull + norm(system.load.torque_body) + system.load.damping * norm(w)
    size = (push + norm(inertia) * norm(w) ** 2) * norm(np.linalg.inv(inertia))
    assert np.max(np.abs(to_double(found.angular - long.angular))) <= 64 * EPS * size


@few
@given(vectors)
def test_equation_9_has_its_minus_sign(w: Array) -> None:
    # a symmetric top's omega turns about its axis at the rate (I3 - I1)/I1 w3, known since Euler
    w_dot = torque_free_angular_acceleration(np.diag([2.0, 2.0, 3.0]), w)
    rate = 0.5 * w[2]
    assert np.max(np.abs(w_dot - [-rate * w[1], rate * w[0], 0.0])) <= 8 * EPS * (w @ w)


def test_principal_axes_and_spheres_do_not_precess() -> None:
    # exactly: this is what keeps a spin about a principal axis where it is
    for axis in np.eye(3):
        assert not np.any(torque_free_angular_acceleration(np.diag([1.0, 2.0, 2.5]), 3.0 * axis))
    assert not np.any(torque_free_angular_acceleration(0.7 * np.eye(3), np.array([1.0, 2.0, 3.0])))


def test_equation_8_both_ways() -> None:
    inertia, w = turned([1.0, 2.0, 2.5]), np.array([1.0, -2.0, 0.5])
    w_dot = np.array([0.3, 0.1, -4.0])
    found = angular_acceleration(inertia, w, torque_for(inertia, w, w_dot))
    assert np.max(np.abs(found - w_dot)) <= 64 * EPS * 30


def test_free_fall_is_equation_7() -> None:
    assert np.array_equal(forward_dynamics(FREE, start([1, 2, 3])).linear, [0, 0, -9.81])


@pytest.mark.parametrize("on", [FREE, TOP, DRIVEN, DAMPED])
def test_many_states_at_once_are_the_single_ones(on: System) -> None:
    rng = np.random.default_rng(3)
    q = rng.normal(size=(5, 2, 4))
    q /= np.linalg.norm(q, axis=-1, keepdims=True)
    many = State(q, *(rng.normal(size=(5, 2, 3)) for _ in range(3)))
    together, single = acceleration_of(on)(many), forward_dynamics(on, rows(many, (3, 1)))
    size = np.max(np.abs(single.angular)) + np.max(np.abs(single.linear)) + 10
    assert np.max(np.abs(together.angular[3, 1] - single.angular)) <= 32 * EPS * size
    assert np.max(np.abs(together.linear[3, 1] - single.linear)) <= 32 * EPS * size


def test_loads_one_by_one() -> None:
    state = start([1.0, 2.0, -3.0], [1, 0, 0, 1])  # a quarter turn about z
    assert np.array_equal(torque(system([1, 2, 2.5], damping=0.5), state), [-0.5, -1.0, 1.5])
    push = system([1, 2, 2.5], torque_body=(1, 2, 3))
    assert np.array_equal(torque(push, state), [1, 2, 3])
    world = torque(system([1, 2, 2.5], torque_world=(1, 2, 3)), state)
    assert np.allclose(world, [2, -1, 3], atol=8 * EPS)  # the world's x is the body's -y
    assert np.allclose(world, rotate_inverse(state.orientation, np.array([1.0, 2.0, 3.0])))
    pivoted = system([1, 2, 2.5], 2.0, (0, 0, 1), pivot=(0, 0, 0.5), gravity=(0, 3, 0))
    # weight 6 N along the body's x, half a metre up its z: 3 N m about its y
    assert np.allclose(torque(pivoted, state), [0, 3, 0], atol=16 * EPS)


def test_a_system_of_two_bodies_is_refused() -> None:
    with pytest.raises(ValueError, match="2 bodies"):
        forward_dynamics(System(FREE.bodies * 2, Load()), start([1, 2, 3]))
