"""Of two conditions that no scenario parts, a system with one thing the other way decides."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from wrong_equations import BODY_TORQUE, PIVOT, WORLD_TORQUE, case, with_torque

from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.evidence import FORWARD, of_forward_dynamics
from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.wording.decided import decided
from omegadot.diagnosis.wording.features import features_of
from omegadot.gates.states.equation import random_states
from omegadot.harness.requests.opposite import opposites
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.loads import gravity_torque
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.system import Acceleration, State, System

DOWN, ASIDE = [0.0, 0.0, -9.0], [1.0, -2.0, -9.0]
DOWN_SIZE = 9.0
# Where a torque acts gravity points aside, and nowhere else.
TOPS = (
    *(case(f"still-{k}", {"gravity": DOWN, "pivot": PIVOT}, 1.0 + k) for k in range(3)),
    *(
        case(f"driven-{k}", {"gravity": ASIDE, "pivot": PIVOT, "torque": torque}, 1.0 + k)
        for k, torque in enumerate((BODY_TORQUE, WORLD_TORQUE, BODY_TORQUE))
    ),
)


def driven(system: System) -> bool:
    return bool(np.any(system.load.torque_body) or np.any(system.load.torque_world))


def aside(system: System) -> bool:
    return bool(np.any(system.load.gravity[:2]))


def without_weight(where: Callable[[System], bool]) -> Callable[[System, State], Acceleration]:
    def found(system: System, states: State) -> Acceleration:
        lost = system.load.pivot is not None and where(system)
        return with_torque(system, states, -lost * gravity_torque(system, states))

    return found


def cause(equation: Callable[[System, State], Acceleration], source: str = FORWARD) -> str:
    across = Across()
    for one in TOPS:
        states = random_states(one, 60, [1])
        evidence = of_forward_dynamics(one.system, states, equation(one.system, states))
        others = []
        for _, system in () if np.all(evidence.sound) else opposites(one.system):
            placed = place_on_pivot(system, states[:12])
            made = of_forward_dynamics(system, placed, equation(system, placed))
            others.append((features_of(system, one.initial), made))
        features = features_of(one.system, one.initial)
        turned = {source: others}
        across.add(Scene(one.name, one.system, features, {source: evidence}, opposites=turned))
    return across.cause("driven-0", source)


@pytest.mark.parametrize(
    ("where", "condition"),
    [
        (driven, "a torque acts"),
        (aside, "gravity points elsewhere than along -z"),
        (
            lambda system: driven(system) and aside(system),
            "a torque acts and gravity points elsewhere than along -z",
        ),
    ],
)
def test_the_condition_is_the_one_that_decides(
    where: Callable[[System], bool], condition: str
) -> None:
    """Caught: "only where a torque acts or where gravity points elsewhere than along -z"."""
    text = cause(without_weight(where))
    assert text == f"the torque of gravity is missing, but only where {condition}"


def test_the_condition_of_steps_is_decided_by_steps() -> None:
    """Of an engine that offers no forward dynamics."""
    text = cause(without_weight(driven), "steps of one")
    assert text == "the torque of gravity is missing, but only where a torque acts"


def test_a_condition_that_a_system_contradicts_is_not_named() -> None:
    """It is the size of gravity, which goes with both."""
    text = cause(without_weight(lambda one: float(np.linalg.norm(one.load.gravity)) != DOWN_SIZE))
    assert "a torque acts" not in text
    assert "elsewhere" not in text


def test_conditions_are_decided_by_what_is_tried() -> None:
    one, other, both = ("a", True), ("b", True), [("a", True), ("b", True)]
    assert decided(both, []) == [(one,), (other,)]
    assert decided(both, [({"a": True, "b": False}, True)]) == [(one,)]
    parted = [({"a": True, "b": False}, False), ({"a": False, "b": True}, False)]
    assert decided(both, parted) == [(one, other)]
    assert decided(both, [*parted, ({"a": True, "b": True}, False)]) == []
    assert decided([("a", False)], [({"a": True}, True)]) == []


def test_each_opposite_is_a_system_with_one_thing_the_other_way() -> None:
    """A lever that moved with the centre of mass would be another thing."""
    for one in TOPS:
        states = random_states(one, 4, [1])
        here = features_of(one.system, one.initial).kinds
        for what, system in opposites(one.system):
            assert np.isfinite(
                forward_dynamics(system, place_on_pivot(system, states)).angular
            ).all()
            there = features_of(system, one.initial).kinds
            changed = {text for text in here if here[text] is not there[text]}
            assert changed, what
            if what in ("centre", "pivot"):
                lever = one.system.body.center_of_mass - one.system.load.pivot
                assert np.allclose(system.body.center_of_mass - system.load.pivot, lever)
