from __future__ import annotations

import pytest
from synthetic_record import build


@pytest.fixture
def record():
    return build()
