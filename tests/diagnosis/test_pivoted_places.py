"""Places of pivoted bodies by another lever, or off by the pivot; free bodies say nothing of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from test_misread_state import Made, causes
from wrong_equations import CASES

from omegadot.gates.case import Case
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.system import Array, State

EVERY = list(CASES)
TOPS = [one.name for one in CASES if one.system.load.pivot is not None]
LEVER = "by the lever from the body's origin, not from the pivot"


def place(state: State, center: Array) -> State:
    return replace(state, position=rotate(state.orientation, center))


def velocity(state: State, center: Array) -> State:
    turning = cross(state.angular_velocity, center)
    return replace(state, linear_velocity=rotate(state.orientation, turning))


WAYS: dict[str, tuple[Callable[[State, Array, Array], State], str]] = {
    "place": (
        lambda s, c, p: place(s, c),
        "the position is R c: the centre of mass's from the body's origin, not from the pivot",
    ),
    "velocity": (
        lambda s, c, p: velocity(s, c),
        f"the linear velocity is omega x R c: {LEVER}",
    ),
    "both": (
        lambda s, c, p: place(velocity(s, c), c),
        f"position and linear velocity are {LEVER}",
    ),
    "in the world": (
        lambda s, c, p: replace(s, position=s.position + p),
        "the position is off by the pivot, taken as a place in the world",
    ),
}


def on_pivots(name: str) -> Made:
    def made(one: Case, state: State) -> State:
        body, pivot = one.system.body, one.system.load.pivot
        if pivot is None:
            return state
        return WAYS[name][0](state, np.asarray(body.center_of_mass), np.asarray(pivot))

    return made


@pytest.mark.parametrize("name", WAYS)
def test_a_place_by_another_lever_is_named_among_free_bodies_that_are_right(name: str) -> None:
    """Caught: a free body, of which there is no such way, that ends the search or contradicts."""
    found = dict(zip((one.name for one in EVERY), causes(on_pivots(name), EVERY), strict=True))
    assert found == {one: [WAYS[name][1]] if one in TOPS else [] for one in found}


def test_free_bodies_that_are_wrong_in_another_way_contradict_it() -> None:
    def made(one: Case, state: State) -> State:
        free = one.system.load.pivot is None
        return replace(state, position=2.0 * state.position + 1.0) if free else pivoted(one, state)

    pivoted = on_pivots("place")
    texts = [text for found in causes(made, EVERY) for text in found]
    assert not any("from the body's origin" in text for text in texts)
