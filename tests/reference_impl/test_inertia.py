"""Equation (5) over each shape, against the integral itself; sums of parts; parallel axes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from reference_cases import EPS, quaternions, vectors

from omegadot.reference_impl.cross_product import skew
from omegadot.reference_impl.from_scenario import body_of_part
from omegadot.reference_impl.inertia import (
    assemble,
    inertia_of_moments,
    parallel_axis,
    place,
)
from omegadot.reference_impl.rotations import rotation_matrix
from omegadot.reference_impl.system import Array, Body
from omegadot.scenarios.parts import Box, Capsule, Cylinder, Ellipsoid, Part, Point, Sphere

few = settings(max_examples=30, derandomize=True, deadline=None)
NODES, WEIGHTS = np.polynomial.legendre.leggauss(12)
ANGLES = 2 * np.pi * np.arange(8) / 8  # exact for the second harmonics that (5) holds


def _scaled(low: Array | float, high: Array | float) -> tuple[Array, Array]:
    half = (np.asarray(high) - low) / 2
    return np.multiply.outer(half, NODES) + np.expand_dims(np.asarray(low) + half, -1), (
        np.multiply.outer(half, WEIGHTS)
    )


def box_points(size: Array) -> tuple[Array, Array]:
    axes = [_scaled(-s / 2, s / 2) for s in size]
    points = np.stack(np.meshgrid(*(a[0] for a in axes), indexing="ij"), axis=-1).reshape(-1, 3)
    weights = np.einsum("i,j,k->ijk", *(a[1] for a in axes)).ravel()
    return points, weights


def turned_points(low: float, high: float, radius: object) -> tuple[Array, Array]:
    """Points and weights of a solid of revolution about z with the profile radius(z)."""
    z, along = _scaled(low, high)
    r, across = _scaled(0.0, np.array([radius(value) for value in z]))
    rho = r[:, :, None] * np.ones(len(ANGLES))
    points = np.stack(
        [rho * np.cos(ANGLES), rho * np.sin(ANGLES), np.broadcast_to(z[:, None, None], rho.shape)],
        axis=-1,
    )
    weights = along[:, None, None] * (across * r)[:, :, None] * np.full(len(ANGLES), np.pi / 4)
    return points.reshape(-1, 3), weights.ravel()


def _capsule_points(radius: float, length: float) -> tuple[Array, Array]:
    half = length / 2
    pieces = [
        turned_points(-half, half, lambda z: radius),
        turned_points(half, half + radius, lambda z: np.sqrt(radius**2 - (z - half) ** 2)),
        turned_points(-half - radius, -half, lambda z: np.sqrt(radius**2 - (z + half) ** 2)),
    ]
    return np.concatenate([p[0] for p in pieces]), np.concatenate([p[1] for p in pieces])


def _ellipsoid_points(radii: Array) -> tuple[Array, Array]:
    points, weights = turned_points(-1.0, 1.0, lambda z: np.sqrt(1 - z**2))
    return points * radii, weights * np.prod(radii)


SOLIDS: list[tuple[Part, tuple[Array, Array]]] = [
    (
        Box(shape="box", size=(0.2, 0.5, 1.5), density=700.0),
        box_points(np.array([0.2, 0.5, 1.5])),
    ),
    (
        Cylinder(shape="cylinder", radius=0.3, length=1.1, density=700.0),
        turned_points(-0.55, 0.55, lambda z: 0.3),
    ),
    (
        Sphere(shape="sphere", radius=0.4, density=700.0),
        _ellipsoid_points(np.array([0.4, 0.4, 0.4])),
    ),
    (
        Ellipsoid(shape="ellipsoid", semi_axes=(0.4, 0.2, 0.7), density=700.0),
        _ellipsoid_points(np.array([0.4, 0.2, 0.7])),
    ),
    (
        Capsule(shape="capsule", radius=0.3, length=0.8, density=700.0),
        _capsule_points(0.3, 0.8),
    ),
]


@pytest.mark.parametrize(("part", "rule"), SOLIDS, ids=[p.shape for p, _ in SOLIDS])
def test_shape_is_the_integral_of_equation_5(part: Part, rule: tuple[Array, Array]) -> None:
    points, weights = rule
    r_x = skew(points)
    integral = np.einsum("n,nji,njk->ik", 700.0 * weights, r_x, r_x)
    body = body_of_part(part)
    # The integrands are polynomials within reach of the rule, but for the roots in the profiles of
    # balls: those appear squared. Left are the roundings of a sum over the points.
    bound = EPS * len(points)
    assert np.max(np.abs(body.inertia - integral)) <= bound * np.max(integral)
    assert abs(body.mass - 700.0 * weights.sum()) <= bound * body.mass


def test_mass_may_be_given_instead_of_density() -> None:
    given_mass = body_of_part(Sphere(shape="sphere", radius=0.5, mass=2.0))
    assert given_mass.mass == 2.0
    assert np.allclose(given_mass.inertia, 0.2 * np.eye(3), rtol=4 * EPS)  # 2/5 m r²
    assert np.array_equal(body_of_part(Point(shape="point", mass=3.0)).inertia, np.zeros((3, 3)))


@few
@given(vectors, vectors)
def test_parallel_axis_is_the_integral_of_a_shifted_cloud(shift: Array, seed: Array) -> None:
    rng = np.random.default_rng(int(1e6 * abs(seed[0])))
    masses, r = rng.uniform(0.1, 2.0, 12), rng.normal(size=(12, 3))
    r -= masses @ r / masses.sum()

    def integral(points: Array) -> Array:
        r_x = skew(points)
        return np.einsum("n,nji,njk->ik", masses, r_x, r_x)

    moved = integral(r) + parallel_axis(masses.sum(), shift)
    size = masses.sum() * (np.max(np.abs(r)) + np.max(np.abs(shift))) ** 2
    assert np.max(np.abs(moved - integral(r + shift))) <= 12 * 16 * EPS * size


@few
@given(quaternions, vectors)
def test_two_halves_of_a_box_are_the_box(q: Array, position: Array) -> None:
    def box(size: tuple[float, float, float], offset: Array) -> Body:
        part = Box(
            shape="box",
            size=size,
            density=500.0,
            position=tuple(position + rotation_matrix(q) @ offset),
            orientation=tuple(q),
        )
        return body_of_part(part)

    whole = box((0.2, 0.4, 1.0), np.zeros(3))
    left = box((0.2, 0.4, 0.3), np.array([0.0, 0.0, -0.35]))
    right = box((0.2, 0.4, 0.7), np.array([0.0, 0.0, 0.15]))
    joined = assemble([left, right])
    # offsets are differences of positions, known to a few eps of |position|, lever about a metre
    bound = 64 * EPS * (1 + np.linalg.norm(position))
    assert abs(joined.mass - whole.mass) <= bound * whole.mass
    assert np.max(np.abs(joined.center_of_mass - whole.center_of_mass)) <= bound
    assert np.max(np.abs(joined.inertia - whole.inertia)) <= bound * whole.mass


def test_placing_a_part_turns_its_tensor_into_body_axes() -> None:
    alone = Body(np.array(2.0), np.zeros(3), np.diag([1.0, 2.0, 3.0]))
    quarter_about_z = np.array([np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)])
    placed = place(alone, np.array([1.0, 2.0, 3.0]), quarter_about_z)
    assert np.allclose(placed.inertia, np.diag([2.0, 1.0, 3.0]), atol=8 * EPS)
    assert np.array_equal(placed.center_of_mass, [1.0, 2.0, 3.0])


def test_dumbbell_of_points() -> None:
    ends = [
        Point(shape="point", mass=m, position=(0.0, 0.0, z)) for m, z in ((1.0, 0.0), (3.0, 4.0))
    ]
    body = assemble([body_of_part(end) for end in ends])
    assert body.mass == 4.0
    assert np.array_equal(body.center_of_mass, [0.0, 0.0, 3.0])
    assert np.array_equal(body.inertia, np.diag([12.0, 12.0, 0.0]))  # reduced mass 3/4 times 4²


def test_moments_broadcast() -> None:
    squares = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])
    many = inertia_of_moments(np.array([1.0, 2.0]), squares)
    assert np.array_equal(many[0], np.diag([5.0, 4.0, 3.0]))
    assert np.array_equal(many[1], 2 * np.diag([11.0, 10.0, 9.0]))


def test_the_parallel_axis_broadcasts() -> None:
    offsets = np.array([[[1.0, 2.0, 3.0], [0.5, 0.0, -1.0]]])
    masses = np.array([[2.0, 3.0]])
    found = parallel_axis(masses, offsets)
    assert found.shape == (1, 2, 3, 3)
    for place_ in np.ndindex(1, 2):
        d = offsets[place_]
        expected = masses[place_] * (d @ d * np.eye(3) - np.outer(d, d))
        np.testing.assert_allclose(
            found[place_], expected, rtol=0, atol=8 * EPS * masses[place_] * 14
        )
