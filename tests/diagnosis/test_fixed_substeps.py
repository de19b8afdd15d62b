"""Steps that are taken as whole substeps of one length: what becomes of the rest of them."""

from __future__ import annotations

import numpy as np
import pytest
from test_load_times import causes

from omegadot.reference_impl.schemes import SCHEMES, Motion
from omegadot.reference_impl.system import Array, System

LENGTH = 0.01
PLANS = ((0.031, 1), (0.0173, 2), (0.009, 3), (0.083, 1))


@pytest.mark.parametrize(
    ("way", "text"),
    [
        (np.floor, "what is left of it is dropped"),
        (np.ceil, "one more makes up for what is left of it"),
        (np.round, "their number is the nearest whole one"),
    ],
)
@pytest.mark.parametrize("longest", [1.0, 0.05])
def test_the_length_of_substeps_and_what_becomes_of_the_rest_are_named(
    way: np.ufunc, text: str, longest: float
) -> None:
    """Caught: no cause, as the steps of every run are short by another part of them."""

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        count = int(way(h / LENGTH)) if LENGTH < h < longest else 1
        for _ in range(count):
            part = LENGTH if LENGTH < h < longest else h
            q, v = SCHEMES["semi-implicit-euler"].step(motion, q, v, part)
        return q, v

    found = causes(step, PLANS)
    whole = "; steps of 0.083 s and longer are taken whole" * (longest < 0.08)
    assert found == [f"a step longer than 0.01 s is taken in substeps of 0.01 s, and {text}{whole}"]


def test_steps_that_are_short_by_one_part_are_no_substeps() -> None:
    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        return SCHEMES["semi-implicit-euler"].step(motion, q, v, 0.97 * h)

    assert not any("substeps" in text for text in causes(step, PLANS))
