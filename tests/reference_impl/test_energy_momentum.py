"""Energy (4, 5) and momenta as sums over point masses that move by equation (3)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from hypothesis import given, settings
from reference_cases import COUNT, EPS, cloud, pivots, rows, seeds, states

from omegadot.reference_impl.energy import (
    kinetic_energy,
    linear_kinetic_energy,
    potential_energy,
    rotational_kinetic_energy,
    total_energy,
)
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.kinematics import (
    place_on_pivot,
    point_position,
    point_velocity,
)
from omegadot.reference_impl.momentum import angular_momentum, linear_momentum
from omegadot.reference_impl.rotations import rotate, turn_in_body
from omegadot.reference_impl.system import Array, State, System

few = settings(max_examples=40, derandomize=True, deadline=None)


def sizes(system: System, state: State, r: Array) -> tuple[float, float]:
    """Upper bounds of mass times speed and of speed, for rounding bounds."""
    reach = np.max(np.abs(r)) + np.linalg.norm(lever(system))
    speed = 2 * np.linalg.norm(state.angular_velocity) * reach + np.linalg.norm(
        state.linear_velocity
    )
    return float(speed) + EPS, float(reach)


@few
@given(seeds, pivots, states())
def test_energy_and_momenta_are_sums_over_particles(
    seed: int, pivot: Array | None, state: State
) -> None:
    system, masses, r = cloud(seed, pivot)
    state = place_on_pivot(system, state)
    v, x = point_velocity(state, r), point_position(state, r)
    speed, reach = sizes(system, state, r)
    mass, bound = masses.sum(), 64 * COUNT * EPS

    energy = 0.5 * masses @ np.sum(v * v, axis=-1)
    assert abs(kinetic_energy(system, state) - energy) <= bound * mass * speed**2
    momentum = masses @ v
    assert np.max(np.abs(linear_momentum(system, state) - momentum)) <= bound * mass * speed
    about = state.position if pivot is None else np.zeros(3)
    moment = np.sum(np.cross(x - about, masses[:, None] * v), axis=0)
    arm = reach + np.linalg.norm(state.position)
    assert np.max(np.abs(angular_momentum(system, state) - moment)) <= bound * mass * speed * arm
    height = -masses @ (x @ system.load.gravity)
    pull = np.linalg.norm(system.load.gravity)
    assert abs(potential_energy(system, state) - height) <= bound * mass * pull * arm
    assert total_energy(system, state) == kinetic_energy(system, state) + potential_energy(
        system, state
    )


@few
@given(seeds, states())
def test_split_of_equation_4(seed: int, state: State) -> None:
    # the cross term vanishes: turning and translating add up
    system, *_ = cloud(seed, None)
    still = replace(state, linear_velocity=np.zeros(3))
    straight = replace(state, angular_velocity=np.zeros(3))
    assert rotational_kinetic_energy(system, state) == kinetic_energy(system, still)
    assert linear_kinetic_energy(system, state) == kinetic_energy(system, straight)


@few
@given(seeds, pivots, states())
def test_momentum_is_the_gradient_and_inertia_the_hessian(
    seed: int, pivot: Array | None, state: State
) -> None:
    # Section 2.3. The energy is quadratic in omega: central differences over a unit are exact.
    system, *_ = cloud(seed, pivot)

    def energy(change: Array) -> Array:
        return kinetic_energy(
            system, replace(state, angular_velocity=state.angular_velocity + change)
        )

    gradient = np.array([(energy(e) - energy(-e)) / 2 for e in np.eye(3)])
    hessian = np.array(
        [
            [energy(a + b) - energy(a) - energy(b) + energy(np.zeros(3)) for b in np.eye(3)]
            for a in np.eye(3)
        ]
    )
    inertia = moving_inertia(system)
    largest = max(energy(2 * e) + energy(-2 * e) for e in np.eye(3)) + np.max(inertia)
    in_body = inertia @ state.angular_velocity
    assert np.max(np.abs(gradient - in_body)) <= 64 * EPS * largest
    assert np.max(np.abs(hessian - inertia)) <= 64 * EPS * largest
    in_world = angular_momentum(system, state)
    assert np.max(np.abs(in_world - rotate(state.orientation, in_body))) <= 64 * EPS * largest


def test_velocity_is_the_derivative_of_position() -> None:
    # a free-flying state moved by its own velocities over a short time: equation (3)
    state = State(
        np.array([0.5, -0.5, 0.5, 0.5]),
        np.array([1.0, -2.0, 0.5]),
        np.array([3.0, 0.0, 1.0]),
        np.array([0.2, 0.4, -0.1]),
    )
    r, h = np.array([0.3, -1.0, 0.6]), 1e-5

    def moved(t: float) -> Array:
        later = replace(
            state,
            orientation=turn_in_body(state.orientation, state.angular_velocity, t),
            position=state.position + t * state.linear_velocity,
        )
        return point_position(later, r)

    speed = np.linalg.norm(state.angular_velocity)
    bound = h**2 / 6 * speed**3 * np.linalg.norm(r) + 8 * EPS * 4 / h
    assert np.max(np.abs((moved(h) - moved(-h)) / (2 * h) - point_velocity(state, r))) <= bound


def test_pivot_point_stands_still_at_the_origin() -> None:
    system, _, _ = cloud(5, np.array([0.3, -0.2, 0.7]))
    rng = np.random.default_rng(6)
    q = rng.normal(size=(7, 4))
    q /= np.linalg.norm(q, axis=-1, keepdims=True)
    any_state = State(q, rng.normal(size=(7, 3)), rng.normal(size=(7, 3)), rng.normal(size=(7, 3)))
    pivoted = place_on_pivot(system, any_state)
    back = -lever(system)
    assert np.max(np.abs(point_position(pivoted, back))) <= 16 * EPS
    assert np.max(np.abs(point_velocity(pivoted, back))) <= 64 * EPS
    one = place_on_pivot(system, rows(any_state, 3))
    assert np.max(np.abs(one.position - pivoted.position[3])) <= 8 * EPS
    assert place_on_pivot(System(system.bodies), any_state) is any_state
