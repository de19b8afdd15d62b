"""Answers of a request that are right of other states of it, or of the request before."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from wrong_equations import CASES

from omegadot.diagnosis.equations.across import Across, Scene
from omegadot.diagnosis.equations.evidence import ALONG, FORWARD, of_forward_dynamics
from omegadot.diagnosis.equations.wrong_equation import equation_causes
from omegadot.diagnosis.wording.features import features_of
from omegadot.gates.bounds.scales import norm
from omegadot.gates.states.equation import random_states
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.system import Acceleration, State, System

N = 60
Answers = Callable[[System, State, State], Acceleration]


def causes(answers: Answers, source: str = FORWARD) -> set[str]:
    """On all scenarios. answers: at the states, of which others were requested before."""
    across = Across()
    for one in CASES:
        states = {FORWARD: random_states(one, N, [1]), ALONG: random_states(one, N, [2])}
        before = states[FORWARD] if source == ALONG else states[ALONG]
        evidence = {
            FORWARD: of_forward_dynamics(
                one.system, states[FORWARD], forward_dynamics(one.system, states[FORWARD])
            )
        }
        found = answers(one.system, states[source], before)
        evidence[source] = of_forward_dynamics(one.system, states[source], found)
        features = features_of(one.system, one.initial)
        across.add(Scene(one.name, one.system, features, evidence))
    wrong = [n for n, s in across.scenes.items() if not np.all(s.evidence[source].sound)]
    assert wrong
    return {text for name in wrong for text in equation_causes(across, name, source)}


def placed(places: Any) -> Answers:
    def answers(system: System, states: State, _: State) -> Acceleration:
        true = forward_dynamics(system, states)
        return replace(true, angular=true.angular[places])

    return answers


PLACES = np.arange(N)
MAPPED = {
    "mod": (PLACES % 16, "state i, from 0, has the omega-dot of state i mod 16"),
    "until": (np.minimum(PLACES, 31), "those after the first 32 have the omega-dot of the last of"),
    "first": (0 * PLACES, "each has the omega-dot of the first"),
    "last": (0 * PLACES + N - 1, "each has the omega-dot of the last"),
    "reversed": (PLACES[::-1], "answered in reverse: the first has the omega-dot of the last"),
    "rolled": (
        np.roll(PLACES, 2),
        "each has the omega-dot of the state 2 before it, and the ends go",
    ),
    "shifted": (np.minimum(PLACES + 1, N - 1), "of the state 1 after it, but for the ends"),
    "blocks": (PLACES - PLACES % 4, "each 4 have the omega-dot of the first of them"),
    "pairs": (PLACES ^ 1, "each 2 are answered in reverse"),
}


@pytest.mark.parametrize("name", MAPPED)
def test_the_place_of_each_answer_is_named(name: str) -> None:
    """Caught: "omega-dot is off, at 36 % of the states", of an index that wraps."""
    places, text = MAPPED[name]
    (found,) = causes(placed(places))
    assert found.startswith(f"of {N} states requested together, ")
    assert text in found


def test_answers_in_no_known_order_are_those_of_other_states() -> None:
    order = np.random.default_rng(3).permutation(N)
    (found,) = causes(placed(order))
    text = "states have the omega-dot of other states that are requested together with them"
    assert found == text


@pytest.mark.parametrize(("sign", "order"), [(1.0, "ascending"), (-1.0, "descending")])
def test_answers_in_the_order_of_their_speed_are_named(sign: float, order: str) -> None:
    def answers(system: System, states: State, _: State) -> Acceleration:
        true, speed = forward_dynamics(system, states), norm(states.angular_velocity)
        return replace(true, angular=true.angular[np.argsort(sign * speed)])

    (found,) = causes(answers)
    text = f"the answers come in {order} order of |omega|"
    assert found == f"of {N} states requested together, {text}"


def test_answers_to_the_request_before_are_named() -> None:
    (found,) = causes(lambda system, _, before: forward_dynamics(system, before), ALONG)
    assert found == "states have the omega-dot of those in the same places of the request before"


def test_wrong_answers_from_one_place_on_are_of_no_other_state() -> None:
    """Not of others: the states from the 17th on lack the gyroscopic term, or have nothing."""

    def zeros(system: System, states: State, _: State) -> Acceleration:
        true = forward_dynamics(system, states)
        return replace(true, angular=np.where(PLACES[:, None] < 16, true.angular, 0.0))

    def mixed(system: System, states: State, _: State) -> Acceleration:
        true = forward_dynamics(system, states)
        rolled = 1.001 * true.angular[PLACES % 16]
        return replace(true, angular=np.where(PLACES[:, None] < 16, true.angular, rolled))

    for answers in (zeros, mixed):
        found = causes(answers)
        assert not any("has the omega-dot" in text for text in found)
        assert not any("have the omega-dot" in text for text in found)


@pytest.mark.parametrize("count", [4, 8])
def test_an_attitude_of_the_first_states_alone_is_named(count: int) -> None:
    """Caught: "nothing else of the state than the attitude is seen to change it"."""

    def answers(system: System, states: State, _: State) -> Acceleration:
        first = states.orientation[PLACES % count]
        return forward_dynamics(system, replace(states, orientation=first))

    text = f"the attitude on its way in is that of the same place in the first {count} among those"
    assert causes(answers) == {f"{text} that are requested together"}
