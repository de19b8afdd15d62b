"""How far a cause holds, in words."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
import pytest

from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.families import ONE_NUMBER
from omegadot.diagnosis.equations.held import Held, Scene, Scenes
from omegadot.diagnosis.equations.searched import Searched
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


@pytest.mark.parametrize(("shown", "kept"), [(1, 2), (2, 1)])
def test_of_one_scenario_no_number_is_likelier_for_fewer_others(shown: int, kept: int) -> None:
    """Caught: "the inertia is scaled by 3e5" for a damping, which one scenario more would show."""
    numbers = [Candidate(family=one, numbers=np.ones(1)) for one in ONE_NUMBER[:2]]
    against = dict(zip((one.key for one in numbers), ("xy", "xyz"), strict=True))

    class Others(Scenes):
        def held(self, one: Candidate, scene: Scene, source: str) -> Held:
            return Held(one, source, scenes(*"ab"[:shown]), scenes(*against[one.key]))

    searched = Searched(Others())
    assert len(searched.held_of(numbers, scenes("a")[0], "").strong) == kept
