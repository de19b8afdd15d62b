"""How far a cause holds, in words."""

from __future__ import annotations

from typing import Any, cast

import pytest

from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.held import Held, Scene
from omegadot.diagnosis.wording.features import Features


def scenes(*names: str) -> list[Scene]:
    """Scenarios that nothing tells apart."""
    return [Scene(name, cast("Any", None), Features({}, {}), {}) for name in names]


@pytest.mark.parametrize(
    ("against", "text"),
    [
        ("xyz", ", not on 3 others that would show it"),
        ("x", ", not on 1 other that would show it"),
        ("", ""),
    ],
)
def test_scenarios_against_a_cause_are_no_support(against: str, text: str) -> None:
    """Caught: "on 1 of the 4 scenarios that would show it", of a cause that three refute."""
    assert Held(Candidate(), "", scenes("top"), scenes(*against)).where("") == text
