"""Pivoted bodies that are placed by another lever, and the law of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from wrong_equations import CASES

from omegadot.diagnosis.models.wrong_lever import law_of_levers
from omegadot.reference_impl.system import Array, System

TOP = next(one.system for one in CASES if one.system.load.pivot is not None)
PLACES = ([0.3, 0.1, -0.2], [0.0, 0.4, 0.1], [-0.2, 0.0, 0.5])


def systems() -> list[System]:
    return [
        replace(
            TOP,
            bodies=(replace(TOP.body, center_of_mass=np.roll(np.array(place), k) * (1.0 + k)),),
            load=replace(TOP.load, pivot=np.array(place)),
        )
        for k, place in enumerate(PLACES, start=1)
    ]


@pytest.mark.parametrize(
    ("lever", "text"),
    [
        (lambda c, p: -p, "either the pivot is taken as given from the centre of mass"),
        (lambda c, p: 0.5 * (c - p), "from the pivot to the centre of mass is scaled by 0.5"),
        (lambda c, p: np.clip(c, -0.3, 0.3) - p, "the centre of mass is limited to 0.3 m either"),
    ],
    ids=["from the centre", "scaled", "limited"],
)
def test_the_law_of_the_lever_is_named(lever: Callable[[Array, Array], Array], text: str) -> None:
    """Caught: a centre of mass that is "limited to 0 m"."""
    every = systems()
    levers = [lever(one.body.center_of_mass, np.asarray(one.load.pivot)) for one in every]
    assert text in law_of_levers(every, levers)
