from __future__ import annotations

import pytest
from chromium import Chromium
from synthetic_record import build


@pytest.fixture
def record():
    return build()


@pytest.fixture(scope="session")
def browser(tmp_path_factory):
    """One browser for all files: each page is loaded anew, in a window of its own size."""
    with Chromium(tmp_path_factory.mktemp("profile")) as chromium:
        yield chromium
