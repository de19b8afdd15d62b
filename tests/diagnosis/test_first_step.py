"""The first step of every run by another scheme; and silence."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from test_over_runs import CASES, kept

from omegadot.diagnosis.stepping.kept_run import SchemeOf
from omegadot.diagnosis.stepping.slips.first_step import first_step_causes
from omegadot.reference_impl.schemes import SCHEMES, Motion
from omegadot.reference_impl.system import Array, System

OWN = "lie-rk4"


def causes(first: str, every: int, count: int = 1, share: float = 1.0) -> list[str]:
    """Of runs whose first steps are of another scheme, or of a part of their length."""

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        if n < count:
            return SCHEMES[first].step(motion, q, v, share * h)
        return SCHEMES[OWN].step(motion, q, v, h)

    runs = [kept(one, step, h, every) for one in CASES for h in (0.02, 0.007)]
    by = SchemeOf(SCHEMES[OWN], "com-world")
    runs = [replace(run, fails=not bool(np.all(run.sound(by)))) for run in runs]
    return first_step_causes(by, runs)


@pytest.mark.parametrize("first", ["semi-implicit-euler", "implicit-midpoint"])
@pytest.mark.parametrize("every", [1, 5])
def test_the_scheme_of_the_first_step_is_named(first: str, every: int) -> None:
    """Caught: "only the first steps are wrong", with no word on what they are."""
    assert causes(first, every) == [f"the first step of a run is by {first}, not by {OWN}"]


def test_two_first_steps_or_one_of_another_length_are_not_named_so() -> None:
    assert causes("semi-implicit-euler", 1, count=2) == []
    assert causes("semi-implicit-euler", 5, count=2) == []
    assert causes(OWN, 5, share=0.5) == []
    assert causes(OWN, 5) == []
