"""What travels in the page comes back: to 0.1 %, in order, with zero and gaps distinguished."""

import base64
import gzip
import json

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from omegadot.reports.charts.packing import (
    CEILING_DECADE,
    FLOOR,
    FLOOR_DECADE,
    codes_of,
    pack_codes,
    pack_json,
)

MAGNITUDES = st.lists(st.floats(1.01e-17, 9.9e19), min_size=1, max_size=50).map(np.array)
CODES = st.lists(st.integers(0, 65535), max_size=200).map(lambda v: np.array(v, np.uint16))


def decoded(codes):
    decades = FLOOR_DECADE + (codes.astype(float) - 1) / 65533 * (CEILING_DECADE - FLOOR_DECADE)
    return 10.0**decades


@settings(derandomize=True, max_examples=60)
@given(MAGNITUDES)
def test_a_value_comes_back_to_a_thousandth(values):
    half_a_step = 10.0 ** (0.5 * (CEILING_DECADE - FLOOR_DECADE) / 65533) - 1
    np.testing.assert_allclose(decoded(codes_of(values)), values, rtol=1.01 * half_a_step)


@settings(derandomize=True, max_examples=60)
@given(MAGNITUDES)
def test_the_order_of_values_is_kept(values):
    assert np.all(np.diff(codes_of(np.sort(values)).astype(int)) >= 0)


def test_zero_gaps_and_overflow_are_distinguished():
    values = np.array([0.0, FLOOR, FLOOR / 3, np.nan, np.inf, 1e300, 1e20])
    assert codes_of(values).tolist() == [0, 0, 0, 65535, 65534, 65534, 65534]


@settings(derandomize=True, max_examples=60)
@given(CODES)
def test_packed_codes_come_back(codes):
    raw = np.frombuffer(
        gzip.decompress(base64.b85decode(str(pack_codes(codes)).replace(",", "<"))), np.uint8
    )
    high, low = raw[: len(codes)].astype(np.uint32), raw[len(codes) :].astype(np.uint32)
    np.testing.assert_array_equal(np.cumsum((high << 8) | low) % 65536, codes)


def test_packed_json_is_safe_inside_a_script_and_the_same_every_time():
    value = {"title": "</script><script>alert(1)</script>"}
    packed = pack_json(value)
    assert "<" not in packed
    assert packed == pack_json(value)
    assert json.loads(gzip.decompress(base64.b85decode(str(packed).replace(",", "<")))) == value
