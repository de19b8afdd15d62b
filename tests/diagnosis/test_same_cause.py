"""Two names of one cause are one; what another pivot would distinguish stays two."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from test_causes import causes_over
from wrong_equations import CASES, case, mirrored_center

from omegadot.gates.case import Case
from omegadot.reference_impl.motion import center_of_mass_acceleration, forward_dynamics
from omegadot.reference_impl.system import Acceleration, State, System

FREE, PIVOTED = CASES[:3], CASES[7:8] + CASES[10:12]


def zero(system: System, states: State) -> Acceleration:
    true = forward_dynamics(system, states)
    return replace(true, angular=0.0 * true.angular)


def zero_that_moves(system: System, states: State) -> Acceleration:
    """On a pivot the centre of mass goes with the omega-dot that is wrong."""
    none = zero(system, states)
    if system.load.pivot is None:
        return none
    return replace(none, linear=center_of_mass_acceleration(system, states, none.angular))


@pytest.mark.parametrize("found", [zero, zero_that_moves])
@pytest.mark.parametrize("cases", [FREE, FREE + PIVOTED])
def test_an_omega_dot_of_zero_has_one_cause(
    found: Callable[[System, State], Acceleration], cases: tuple[Case, ...]
) -> None:
    """Caught: "or the omega-dot that is reported is missing" beside it, which is the same."""
    assert set(causes_over(found, cases).values()) == {"omega-dot is zero"}


def test_causes_that_one_pivot_alone_makes_one_are_all_named() -> None:
    """The pivot lies at twice the centre of mass: mirrored, the lever is that from the origin.

    Caught: omega-dot held against each other on free bodies alone, on which no lever acts.
    """
    center = np.array(CASES[0].system.body.center_of_mass)
    top = case("top", {"gravity": [1.0, -3.0, -9.0], "pivot": [*2.0 * center]})

    def reported(system: System, states: State) -> Acceleration:
        wrong = mirrored_center(system, states).angular
        return replace(forward_dynamics(system, states), angular=wrong)

    (text,) = causes_over(reported, (top, CASES[1])).values()
    assert "the centre of mass is mirrored" in text
    assert "the lever is the centre of mass's from the origin" in text
    assert "the body is pivoted at its origin" in text
