"""The coordinates that a body is stepped in: one motion, whichever they are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from reference_cases import (
    DAMPED,
    DRIVEN,
    EPS,
    TOP,
    in_long_double,
    start,
    states,
    system,
    systems,
    turned,
)

from omegadot.reference_impl.coordinates import (
    COORDINATES,
    Coordinates,
    acceleration_in,
    canonical,
    distinct,
    from_coordinates,
    to_coordinates,
)
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.motion import acceleration_of, forward_dynamics
from omegadot.reference_impl.one_body.body_motion import body_motion, motion_over
from omegadot.reference_impl.rotations import attitude_angle, rotation_matrix
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.solutions.series import solve_series
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, State, System

few = settings(max_examples=30, derandomize=True, deadline=None)
every = pytest.mark.parametrize("coordinates", COORDINATES)
OFFSET = system(
    turned([1, 2, 2.5]),
    center=(0.1, -0.2, 0.3),
    gravity=(0, 1, -9),
    damping=0.3,
    torque_body=(1, 0, 2),
    torque_world=(0, 2, 1),
)
INITIAL = start([1.0, 2.0, -1.5], [1, 2, 3, 4], (1, 2, 3), (0.5, -1, 2))


def lanes_of(state: State, count: int) -> State:
    return State(*(np.repeat(field[None], count, axis=0) for field in vars(state).values()))


@every
@few
@given(systems(), states())
def test_states_come_back(coordinates: Coordinates, on: System, state: State) -> None:
    state = place_on_pivot(on, state)
    back = from_coordinates(on, *to_coordinates(on, state, coordinates), coordinates)
    reach = 64 * EPS * (1 + 27 + 3 * np.linalg.norm(on.body.center_of_mass))
    for found, expected in zip(vars(back).values(), vars(state).values(), strict=True):
        assert np.max(np.abs(found - expected)) <= reach


def test_the_spatial_velocity_is_the_origins_in_body_axes() -> None:
    q, v = to_coordinates(OFFSET, INITIAL, "body-spatial")
    R, c = rotation_matrix(INITIAL.orientation), OFFSET.body.center_of_mass
    w = INITIAL.angular_velocity
    assert np.allclose(q[:3], INITIAL.position - R @ c, atol=16 * EPS)
    assert np.allclose(v[:3], R.T @ INITIAL.linear_velocity - np.cross(w, c), atol=32 * EPS)
    assert np.array_equal(q[3:], INITIAL.orientation)
    assert np.array_equal(v[3:], w)


@every
@pytest.mark.parametrize("on", [OFFSET, TOP], ids=["free", "pivoted"])
def test_accelerations_are_the_rates_of_the_velocities(
    coordinates: Coordinates, on: System
) -> None:
    """Of the exact motion, by a central difference over 2^-10 s."""
    h, initial = 2.0**-10, place_on_pivot(on, INITIAL)
    times = np.array([0.0, h, 2 * h])
    path = solve_series(on, initial, times)
    q, v = to_coordinates(on, path, coordinates)
    slope = (v[2] - v[0]) / (2 * h)
    found = body_motion(on, coordinates).acceleration(q[1], v[1])
    assert np.max(np.abs(found - slope)) <= 1e3 * h * h  # the third derivative is about 20^3 / 6


@every
@few
@given(systems(), states())
def test_components_are_the_equations_in_arrays(
    coordinates: Coordinates, on: System, state: State
) -> None:
    """One body in floats, lanes in arrays, and the equations of `motion` agree to rounding."""
    state = place_on_pivot(on, state)
    motion = body_motion(on, coordinates)
    q, v = to_coordinates(on, state, coordinates)
    one = motion.acceleration(q, v)
    many = motion.acceleration(np.array([q, q]), np.array([v, v]))
    arrays = acceleration_in(on, state, forward_dynamics(on, state), coordinates)
    other = motion_over(on, coordinates, acceleration_of(on)).acceleration(q, v)
    condition = float(np.linalg.cond(moving_inertia(on)))
    scale = 27 * 64 * (1 + float(np.linalg.norm(on.body.center_of_mass))) ** 2
    bound = 64 * EPS * condition * (scale + np.max(np.abs(arrays)))
    for found in (one, many[0], many[1], other):
        assert np.max(np.abs(found - arrays)) <= bound


@every
@few
@given(systems(), states(), st.floats(1e-9, 2.0))
def test_one_body_moves_as_lanes_do(
    coordinates: Coordinates, on: System, state: State, h: float
) -> None:
    motion = body_motion(on, coordinates)
    q, v = to_coordinates(on, state, coordinates)
    u, w = h * v, v[::-1].copy()
    for moved in (motion.retract, motion.coordinate_rate):
        one, many = moved(q, u), moved(np.array([q, q]), np.array([u, u]))
        assert np.max(np.abs(many - one)) <= 64 * EPS * (1 + np.max(np.abs(one)))
    pairs = [motion.rate_to_second_order]
    if coordinates != "body-spatial" or on.load.pivot is not None:
        pairs.append(motion.rate)
    for rate in pairs:
        one, many = rate(u, w), rate(np.array([u, u]), np.array([w, w]))
        # c u × (u × ω): its terms are larger than their sum where |u| is
        assert np.max(np.abs(many - one)) <= 64 * EPS * (1 + np.max(u * u)) * (
            1 + np.max(np.abs(w))
        )
    one, many = motion.cayley(u), motion.cayley(np.array([u, u]))
    assert np.max(np.abs(many - one)) <= 64 * EPS * (1 + np.max(np.abs(u)))
    one, many = motion.normalize(2 * q), motion.normalize(np.array([2 * q, 2 * q]))
    assert np.max(np.abs(many - one)) <= 4 * EPS * (1 + np.max(np.abs(one)))


@pytest.mark.parametrize("name", SCHEMES)
@pytest.mark.parametrize("on", [OFFSET, DAMPED, DRIVEN, TOP])
def test_one_body_steps_as_lanes_do(name: str, on: System) -> None:
    for coordinates in SCHEMES[name].coordinates:
        how = (0.01, 20, 5, coordinates)
        one = step_body(SCHEMES[name], on, INITIAL, *how)[1]
        many = step_body(SCHEMES[name], on, lanes_of(INITIAL, 3), *how)[1]
        assert np.max(attitude_angle(many.orientation[:, 1], one.orientation)) <= 20 * 64 * EPS
        for field in ("angular_velocity", "position", "linear_velocity"):
            here, there = getattr(one, field), getattr(many, field)[:, 1]
            assert np.max(np.abs(here - there)) <= 20 * 64 * EPS * np.max(np.abs(here))


def test_lanes_may_differ_in_the_system() -> None:
    scales = np.array([1.0, 2.0, 4.0])
    bodies = replace(OFFSET.body, inertia=scales[:, None, None] * OFFSET.body.inertia)
    load = replace(OFFSET.load, damping=scales * OFFSET.load.damping)
    many = System((bodies,), load)
    ends = step_body(SCHEMES["lie-rk4"], many, lanes_of(INITIAL, 3), 0.01, 5, 5, "body-spatial")[1]
    for lane, scale in enumerate(scales):
        body = replace(OFFSET.body, inertia=scale * OFFSET.body.inertia)
        on = System((body,), replace(OFFSET.load, damping=scale * OFFSET.load.damping))
        end = step_body(SCHEMES["lie-rk4"], on, INITIAL, 0.01, 5, 5, "body-spatial")[1]
        for here, there in zip(vars(ends).values(), vars(end).values(), strict=True):
            assert np.max(np.abs(here[-1, lane] - there[-1])) <= 1e3 * EPS


def test_extended_precision_is_kept_in_components() -> None:
    long = replace(OFFSET, bodies=(in_long_double(OFFSET.body),), load=in_long_double(OFFSET.load))
    state = in_long_double(INITIAL)
    for coordinates in COORDINATES:
        q, v = to_coordinates(long, state, coordinates)
        found = body_motion(long, coordinates).acceleration(q, v)
        plain = body_motion(OFFSET, coordinates).acceleration(q.astype(float), v.astype(float))
        assert found.dtype == np.longdouble
        assert 0 < np.max(np.abs(found - plain)) <= 1e3 * EPS or np.finfo(found.dtype).eps == EPS


def test_what_coordinates_are_another_computation() -> None:
    centred = System((replace(OFFSET.body, center_of_mass=np.zeros(3)),), OFFSET.load)
    assert distinct(OFFSET) == COORDINATES
    assert distinct(centred) == ("com-world", "body-spatial")
    assert distinct(TOP) == ("com-world",)
    assert canonical(TOP, "body-spatial") == "com-world"
    assert canonical(centred, "origin-world") == "com-world"
    assert canonical(OFFSET, "origin-world") == "origin-world"


@pytest.mark.parametrize("name", ["semi-implicit-euler", "lie-rk4", "lie-rk4-naive"])
def test_steps_in_body_axes_do_not_depend_on_where_the_origin_is(name: str) -> None:
    """The exponential of SE(3) and its brackets turn into each other by a change of the frame."""
    free = replace(OFFSET.load, torque_world=np.zeros(3))
    ends = []
    for center in (OFFSET.body.center_of_mass, np.zeros(3)):
        on = System((replace(OFFSET.body, center_of_mass=center),), free)
        ends.append(step_body(SCHEMES[name], on, INITIAL, 0.05, 20, 20, "body-spatial")[1])
    for here, there in zip(*(vars(end).values() for end in ends), strict=True):
        assert np.max(np.abs(here - there)) <= 20 * 64 * EPS * np.max(np.abs(there))


def test_a_scheme_is_refused_in_coordinates_that_it_does_not_know() -> None:
    with pytest.raises(ValueError, match="munthe-kaas-rk4 is not known in body-spatial"):
        step_body(SCHEMES["munthe-kaas-rk4"], OFFSET, INITIAL, 0.01, 2, 1, "body-spatial")
    step_body(SCHEMES["munthe-kaas-rk4"], TOP, INITIAL, 0.01, 2, 1, "body-spatial")


def array_exponential(u: Array) -> Array:
    """The exponential of se(3) as a 4x4 matrix, by its series."""
    x, y, z, a, b, c = u
    generator = np.array([[0, -c, b, x], [c, 0, -a, y], [-b, a, 0, z], [0, 0, 0, 0.0]])
    total = term = np.eye(4)
    for k in range(1, 40):
        term = term @ generator / k
        total = total + term
    return total


@pytest.mark.parametrize("size", [0.0, 1e-12, 1e-6, 1e-3, 0.1, 2.0])
def test_the_spatial_exponential_and_cayley_are_those_of_matrices(size: float) -> None:
    u = np.array([0.7, -1.1, 0.4, *(size * np.array([0.6, 0.0, 0.8]))])
    motion, here = body_motion(OFFSET, "body-spatial"), np.array([0, 0, 0, 1.0, 0, 0, 0])
    found, expected = motion.retract(here, u), array_exponential(u)
    assert np.max(np.abs(found[:3] - expected[:3, 3])) <= 32 * EPS
    assert np.max(np.abs(rotation_matrix(found[3:]) - expected[:3, :3])) <= 32 * EPS
    x, y, z, a, b, c = u / 2
    half = np.array([[0, -c, b, x], [c, 0, -a, y], [-b, a, 0, z], [0, 0, 0, 0.0]])
    expected = np.linalg.solve(np.eye(4) - half, np.eye(4) + half)
    found = motion.retract(here, motion.cayley(u))
    assert np.max(np.abs(found[:3] - expected[:3, 3])) <= 64 * EPS
    assert np.max(np.abs(rotation_matrix(found[3:]) - expected[:3, :3])) <= 64 * EPS


def test_the_spatial_series_moves_the_exponential_with_v() -> None:
    """``exp(u + ε u̇) = exp(u) exp(ε v)``, but for the terms from the fourth power of u on."""
    motion, v = body_motion(OFFSET, "body-spatial"), np.array([1.0, -2.0, 0.5, 0.3, -1.0, 2.0])
    gaps = []
    for size in (0.4, 0.2):
        u, step = size * np.array([0.7, -1.1, 0.4, 0.6, 0.0, 0.8]), 2.0**-17
        moved = step * motion.rate_to_second_order(u, v)
        change = array_exponential(u + moved) - array_exponential(u - moved)
        slope = np.linalg.solve(array_exponential(u), change) / (2 * step)
        found = np.array([*slope[:3, 3], slope[2, 1], slope[0, 2], slope[1, 0]])
        gaps.append(np.max(np.abs(found - v)))
    assert abs(np.log2(gaps[0] / gaps[1]) - 4) < 0.15
