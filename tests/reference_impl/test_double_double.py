"""Double-word arithmetic against exact fractions, and what it refuses."""

from __future__ import annotations

import operator
from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from omegadot.reference_impl.arithmetic.double_double import DoubleDouble
from omegadot.reference_impl.arithmetic.double_words import (
    fast_two_sum,
    split,
    two_product,
    two_sum,
)

U = Fraction(1, 2**53)

# far enough from the ends of a double's range for a product's error to be a double
doubles = st.floats(1e-100, 1e100).flatmap(lambda x: st.sampled_from([x, -x]))


@st.composite
def numbers(draw: st.DrawFn) -> DoubleDouble:
    """One number with all its 106 bits in use."""
    high, low = draw(doubles), draw(st.floats(-0.49, 0.49))
    return DoubleDouble(*two_sum(np.array(high), np.array(low * np.spacing(abs(high)))))


def exact(value: DoubleDouble) -> Fraction:
    return Fraction(float(value.high)) + Fraction(float(value.low))


def normal(value: DoubleDouble) -> bool:
    """Whether the high part is the number rounded to a double."""
    return bool(np.all(value.high + value.low == value.high))


@given(doubles, doubles)
def test_transforms_leave_no_error(a: float, b: float) -> None:
    for transform, truth in (
        (two_sum, Fraction(a) + Fraction(b)),
        (two_product, Fraction(a) * Fraction(b)),
    ):
        value, error = transform(np.array(a), np.array(b))
        assert Fraction(float(value)) + Fraction(float(error)) == truth
        assert value + error == value
    large, small = sorted((a, b), key=abs, reverse=True)
    value, error = fast_two_sum(np.array(large), np.array(small))
    assert Fraction(float(value)) + Fraction(float(error)) == Fraction(a) + Fraction(b)
    leading, rest = split(np.array(a))
    assert Fraction(float(leading)) + Fraction(float(rest)) == Fraction(a)
    for part in (float(leading), float(rest)):  # half the digits: products of two are exact
        assert Fraction(part * part) == Fraction(part) ** 2


@given(numbers(), numbers())
@pytest.mark.parametrize(
    ("operation", "ulps"),  # bounds of the source's table 1; division's with its last two steps
    [(operator.add, 4), (operator.sub, 4), (operator.mul, 8), (operator.truediv, 16)],
    ids=["add", "subtract", "multiply", "divide"],
)
def test_arithmetic_errs_by_a_few_squares_of_the_unit(
    operation: Callable[..., DoubleDouble], ulps: int, a: DoubleDouble, b: DoubleDouble
) -> None:
    found, truth = operation(a, b), operation(exact(a), exact(b))
    assert abs(exact(found) - truth) <= ulps * U**2 * abs(truth)
    assert normal(found)


@given(numbers())
def test_a_root_squared_is_the_number(a: DoubleDouble) -> None:
    found = np.sqrt(abs(a))
    assert abs(exact(found) ** 2 - abs(exact(a))) <= 16 * U**2 * abs(exact(a))
    assert not np.any(np.sqrt(DoubleDouble.of(0.0)))


@given(st.lists(st.tuples(numbers(), numbers()), min_size=1, max_size=30))
def test_products_of_matrices_and_sums_err_by_the_size_of_their_terms(
    terms: list[tuple[DoubleDouble, DoubleDouble]],
) -> None:
    row, column = (np.stack([pair[i] for pair in terms]) for i in (0, 1))
    products = [exact(a) * exact(b) for a, b in terms]
    bound = (len(terms) + 2) ** 2 * 4 * U**2
    for found in (row @ column, (row[None] @ column[:, None])[0, 0]):
        assert abs(exact(found) - sum(products)) <= bound * max(map(abs, products)) * len(terms)
    total = np.add.reduce(row, 0)
    assert abs(exact(total) - sum(exact(a) for a, _ in terms)) <= bound * len(terms) * max(
        abs(exact(a)) for a, _ in terms
    )


def test_sums_that_cancel_keep_what_is_left() -> None:
    terms = DoubleDouble.of(np.array([1e16, 1.0, -1e16, 2.0**-40]))
    assert exact(np.add.reduce(terms, 0)) == 1 + Fraction(1, 2**40)
    ones = DoubleDouble.of(np.ones(4))
    assert exact(ones @ terms) == 1 + Fraction(1, 2**40)


def test_shapes_are_those_of_arrays() -> None:
    rng = np.random.default_rng(1)
    a, b = rng.normal(size=(2, 3, 4)), rng.normal(size=(4, 5))
    aa, bb = DoubleDouble.of(a), DoubleDouble.of(b)
    for found, like in (
        (aa @ bb, a @ b),
        (aa @ b, a @ b),
        (a @ bb, a @ b),
        (aa[0, 0] @ bb, a[0, 0] @ b),
        (aa @ bb[:, 0], a @ b[:, 0]),
        (np.add.reduce(aa, -1, keepdims=True), np.add.reduce(a, -1, keepdims=True)),
        (np.swapaxes(aa, -1, -2), np.swapaxes(a, -1, -2)),
        (np.stack([aa, a]), np.stack([a, a])),
        (np.concatenate([aa, a], -1), np.concatenate([a, a], -1)),
        (aa.take([1, 0], -1).reshape(-1, 2).T, a.take([1, 0], -1).reshape(-1, 2).T),
        (np.zeros_like(aa, shape=(3, 1)), np.zeros((3, 1))),
        (1.0 - aa / 2, 1.0 - a / 2),
    ):
        assert found.shape == found.low.shape == like.shape
        assert np.max(np.abs(found.astype(float) - like)) <= 32 * float(U)
    assert np.array_equal(aa > 0.0, a > 0.0)
    assert (np.ndim(aa), np.shape(aa), len(aa)) == (3, (2, 3, 4), 2)


def test_parts_can_be_set_and_changed_in_place() -> None:
    a = DoubleDouble.of(np.zeros((2, 3)))
    a[0] = DoubleDouble.of(np.ones(3)) / 3.0
    kept = a.copy()
    a[0] *= 3.0
    assert abs(exact(a[0, 1]) - 1) <= 32 * U**2
    assert exact(kept[0, 1]) != exact(a[0, 1])
    assert not np.any(a[1])


def test_the_low_part_is_never_dropped_in_silence() -> None:
    a = DoubleDouble.of(np.ones(3))
    with pytest.raises(TypeError, match="to_double"):
        np.asarray(a)
    for function in (np.cos, np.linalg.norm, np.maximum.reduce):
        with pytest.raises(TypeError):
            function(a)


def test_long_doubles_keep_their_last_bits() -> None:
    long = np.array([1.0, -3.0, 1e300], np.longdouble) / 3
    assert np.array_equal(DoubleDouble.of(long).astype(np.longdouble), long)


def test_what_is_not_finite_is_no_number() -> None:
    a = DoubleDouble.of(np.array([np.inf, np.nan, 1e300]))
    assert not np.any(np.isfinite(a * a))
    assert np.isfinite(a - 1.0).tolist() == [False, False, True]
