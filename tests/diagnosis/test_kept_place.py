"""States that read back on the pivot of a system loaded before, over scenarios in one order."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pytest
from test_misread_state import set_states
from wrong_equations import CASES, GRAVITY, case

from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.models.kept_place import kept_place
from omegadot.diagnosis.wording.features import features_of
from omegadot.gates.bounds.scales import EPS
from omegadot.harness.loaded_before import Loads
from omegadot.reference_impl.kinematics import at_point, place_on_pivot
from omegadot.reference_impl.system import Array, State, System

Engine = Callable[[Sequence[System], State], State]
ORDER = (
    CASES[0],
    case("first-top", {"gravity": GRAVITY, "pivot": [0.1, 0.2, 0.3]}),
    *(CASES[7], CASES[1], CASES[3], CASES[5]),
    case("last-top", {"pivot": [-0.2, 0.4, 0.0]}, 1.1),
    *(CASES[6], CASES[8]),
)


def cause(engine: Engine) -> str:
    loads, systems, scenes = Loads(), list[System](), list[Scene]()
    for number, one in enumerate(ORDER):
        loads.add(one.system)
        systems.append(one.system)
        requested = set_states(one, number)
        back = engine(systems, requested)
        features = features_of(one.system, one.initial)
        before = {"": loads.before}
        scenes.append(
            Scene(one.name, one.system, features, {}, before=before, states=(requested, back))
        )
    return kept_place(scenes, ORDER[0], EPS)


def on_pivot(system: System, pivot: Array, state: State) -> State:
    still = np.zeros(3)
    placed = State(state.orientation, state.angular_velocity, still, still)
    return at_point(placed, system.body.center_of_mass - pivot)


def last_pivot(systems: Sequence[System], state: State) -> State:
    """What was not cleared."""
    given = [one.load.pivot for one in systems if one.load.pivot is not None]
    return on_pivot(systems[-1], given[-1], state) if given else state


def before_alone(systems: Sequence[System], state: State) -> State:
    """Of the system before, where that one has a pivot."""
    own, last = systems[-1], systems[-2:][0]
    kept = own.load.pivot is None and last.load.pivot is not None
    return on_pivot(own, np.asarray(last.load.pivot), state) if kept else state


def old_centre(systems: Sequence[System], state: State) -> State:
    own, last = systems[-1], systems[-2:][0]
    if own.load.pivot is None:
        return state
    return at_point(
        State(state.orientation, state.angular_velocity, np.zeros(3), np.zeros(3)),
        last.body.center_of_mass * (1.0 + (last is not own)) - own.load.pivot,
    )


@pytest.mark.parametrize(
    ("engine", "text"),
    [
        (last_pivot, "that of a system loaded before is kept: of the last that had any"),
        (before_alone, "where no pivot is requested, that of the system loaded before is kept"),
    ],
)
def test_the_pivot_that_is_kept_is_named(engine: Engine, text: str) -> None:
    """Caught: "something of it is left over" on the one scenario that is loaded first."""
    assert cause(engine).endswith(text)


def test_what_no_system_before_had_is_not_kept() -> None:
    """A constant pivot, places that are off, and a sound engine."""

    def constant(systems: Sequence[System], state: State) -> State:
        free = systems[-1].load.pivot is None and len(systems) > 1
        return on_pivot(systems[-1], np.array([0.1, 0.2, 0.3]), state) if free else state

    def off(systems: Sequence[System], state: State) -> State:
        made = at_point(state, np.array([0.01, 0.0, 0.0]))
        return made if systems[-1].load.pivot is None else state

    for engine in (constant, off, old_centre, lambda systems, x: place_on_pivot(systems[-1], x)):
        assert cause(engine) == ""
