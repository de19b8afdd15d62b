"""The cross product's matrix (1), its derivative (2) and the identities of appendix 4.1."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from reference_cases import EPS, vectors

from omegadot.reference_impl.cross_product import (
    cross,
    nested_left,
    nested_right,
    skew,
    skew_of_cross,
)

few = settings(max_examples=50, derandomize=True, deadline=None)
norm = np.linalg.norm


def test_matrix_is_equation_1() -> None:
    expected = np.array([[0.0, -3.0, 2.0], [3.0, 0.0, -1.0], [-2.0, 1.0, 0.0]])
    assert np.array_equal(skew(np.array([1.0, 2.0, 3.0])), expected)


@few
@given(vectors, vectors)
def test_cross_is_numpys_and_the_matrix_product(a: np.ndarray, b: np.ndarray) -> None:
    # two products and one difference each: three roundings of at most |a||b|
    bound = 3 * EPS * norm(a) * norm(b)
    assert np.max(np.abs(cross(a, b) - np.cross(a, b))) <= bound
    assert np.max(np.abs(skew(a) @ b - np.cross(a, b))) <= bound


@few
@given(vectors, vectors)
def test_antisymmetry_is_exact(a: np.ndarray, b: np.ndarray) -> None:
    assert np.array_equal(cross(a, b), -cross(b, a))
    assert np.array_equal(cross(a, a), np.zeros(3))
    assert np.array_equal(skew(a).T, -skew(a))


@few
@given(vectors, vectors, vectors)
def test_identities_of_the_appendix(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> None:
    # at most three products deep, three terms each, on either side
    bound = 24 * EPS * norm(a) * norm(b) * norm(c)
    assert np.max(np.abs(nested_right(a, b, c) - np.cross(a, np.cross(b, c)))) <= bound
    assert np.max(np.abs(nested_left(a, b, c) - np.cross(np.cross(a, b), c))) <= bound
    jacobi = skew_of_cross(a, b) - skew(np.cross(a, b))
    assert np.max(np.abs(jacobi)) <= 24 * EPS * norm(a) * norm(b)


def test_derivative_by_the_second_factor_is_the_matrix() -> None:
    # linear, so the difference quotient over a whole unit is the derivative (2)
    w, v = np.array([1.0, -2.0, 0.5]), np.array([0.25, 3.0, -1.0])
    columns = np.stack([cross(w, v + e) - cross(w, v) for e in np.eye(3)], axis=-1)
    assert np.array_equal(columns, skew(w))


@pytest.mark.parametrize("dtype", [np.float32, np.float64, np.longdouble])
def test_leading_axes_and_type_are_kept(dtype: type) -> None:
    rng = np.random.default_rng(1)
    a, b = (rng.normal(size=(4, 5, 3)).astype(dtype) for _ in range(2))
    assert cross(a, b).dtype == skew(a).dtype == dtype
    assert np.array_equal(cross(a, b)[2, 3], cross(a[2, 3], b[2, 3]))
    assert np.array_equal(skew(a)[2, 3], skew(a[2, 3]))
