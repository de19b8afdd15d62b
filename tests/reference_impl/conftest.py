"""Tests of the truth run in each of the two extended types."""

from __future__ import annotations

import pytest

from omegadot.reference_impl.arithmetic.precision import (
    DOUBLE_DOUBLE,
    LONG_DOUBLE,
    VARIABLE,
    extended_type,
)


@pytest.fixture(params=[LONG_DOUBLE, DOUBLE_DOUBLE])
def extended_type_of_truth(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """Force double-double, or leave the platform's own, which may be that as well."""
    monkeypatch.delenv(VARIABLE, raising=False)
    if request.param == DOUBLE_DOUBLE:
        monkeypatch.setenv(VARIABLE, DOUBLE_DOUBLE)
    return extended_type()
