"""Numbers as people read them: one form, whatever their size."""

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from omegadot.written import exactly, written

FORM = re.compile(r"-?(0|[1-9]\d*)(\.\d*[1-9])?(e-?[1-9]\d*)?")


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        *((0.21, 2, "0.21"), (0.005, 6, "0.005"), (2.0, 2, "2"), (450.0, 2, "450")),
        *((3.1e-15, 2, "3.1e-15"), (2.8e6, 2, "2.8e6"), (1e13, 2, "1e13"), (-0.05, 2, "-0.05")),
        *((1e-4, 6, "0.0001"), (9.99e-5, 6, "9.99e-5"), (9.999e-5, 2, "0.0001")),
        *((99999.6, 6, "99999.6"), (123456, 6, "123456"), (12345, 2, "12000"), (1e5, 2, "1e5")),
        *((0.0, 2, "0"), (-0.0, 2, "0"), (5e-324, 1, "5e-324"), (None, 2, "–")),
        *((math.inf, 2, "inf"), (math.nan, 2, "nan"), (10**400, 6, "beyond 1e308")),
    ],
)
def test_a_number_has_one_form(value: float | None, digits: int, text: str) -> None:
    assert written(value, digits) == text


@given(st.floats(allow_nan=False, allow_infinity=False), st.integers(1, 17))
def test_it_is_the_number_to_its_digits(value: float, digits: int) -> None:
    """Caught: an exponent with a plus or zeros, zeros at the end, a digit that is lost."""
    text = written(value, digits)
    assert FORM.fullmatch(text), text
    assert float(text) == float(f"{value:.{digits - 1}e}")


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_exactly_is_read_back(value: float) -> None:
    assert float(exactly(value)) == value
    assert len(exactly(value)) <= len(repr(value))
