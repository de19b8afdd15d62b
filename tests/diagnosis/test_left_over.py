"""Something of a system loaded before is kept: which quantity, and when, over several scenarios."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from wrong_equations import CASES, GRAVITY, case

from omegadot.adapters.reference import ReferenceAdapter
from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.equation_form import accelerations, form_of
from omegadot.diagnosis.equations.evidence import of_forward_dynamics
from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.equations.left_over import FEW
from omegadot.diagnosis.equations.wrong_equation import (
    FORWARD,
    RELOADED,
    equation_causes,
)
from omegadot.diagnosis.wording.features import features_of
from omegadot.gates.case import Case
from omegadot.gates.states.equation import random_states
from omegadot.harness.in_process import driver_of
from omegadot.harness.loaded_before import Loads
from omegadot.harness.requests.repeats import OTHERS
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.system import Acceleration, State, System

# What an engine answers at states of the systems that it was loaded with, the last one last.
Engine = Callable[[Sequence[System], State], Acceleration]


def of_load(take: Callable[[Sequence[Any]], dict[str, Any]]) -> Engine:
    """An engine of which the load is another, made from all loads so far."""

    def engine(systems: Sequence[System], states: State) -> Acceleration:
        load = replace(systems[-1].load, **take([one.load for one in systems]))
        return forward_dynamics(replace(systems[-1], load=load), states)

    return engine


def of_body(take: Callable[[Sequence[System]], dict[str, Any]]) -> Engine:
    def engine(systems: Sequence[System], states: State) -> Acceleration:
        body = replace(systems[-1].body, **take(systems))
        return forward_dynamics(replace(systems[-1], bodies=(body,)), states)

    return engine


def last_given(name: str) -> Engine:
    """A load that is not requested stays that of the last system with one."""

    def take(loads: Sequence[Any]) -> dict[str, Any]:
        given = [v for one in loads if (v := getattr(one, name)) is not None and np.any(v)]
        return {name: given[-1] if given else getattr(loads[-1], name)}

    return of_load(take)


def old_inverse(systems: Sequence[System], states: State) -> Acceleration:
    """The inertia is inverted for the next system only."""
    before, now = (np.asarray(moving_inertia(one)) for one in (systems[-2:][0], systems[-1]))
    true = forward_dynamics(systems[-1], states)
    angular = np.linalg.solve(before, now @ true.angular[..., None])[..., 0]
    return replace(true, angular=angular)


def of_equation(
    one: Callable[[System, System], bool], first: bool, *parts: str
) -> Callable[[Sequence[System], State], Acceleration]:
    """Parts of the equation that are those of the first, or the last, earlier system alike."""

    def engine(systems: Sequence[System], states: State) -> Acceleration:
        alike = [s for s in systems[:-1] if one(s, systems[-1])] or [systems[-1]]
        own, kept = form_of(systems[-1]), form_of(alike[0 if first else -1])
        return accelerations(replace(own, **{p: getattr(kept, p) for p in parts}), states)

    return engine


def of_one_mass(one: System, other: System) -> bool:
    return float(one.body.mass) == float(other.body.mass)


def of_one_support(one: System, other: System) -> bool:
    return of_one_mass(one, other) and (one.load.pivot is None) is (other.load.pivot is None)


def same_mass(systems: Sequence[System]) -> dict[str, Any]:
    """The inertia of the first system with this mass."""
    own = systems[-1].body.mass
    return {"inertia": next(s.body.inertia for s in systems if s.body.mass == own)}


def of_one_pivot(systems: Sequence[System]) -> dict[str, Any]:
    """The centre of mass of the first system with this pivot."""
    own = systems[-1].load.pivot
    with_pivot = [s for s in systems if s.load.pivot is not None]
    alike = [s for s in with_pivot if own is not None and np.array_equal(s.load.pivot, own)]
    return {"center_of_mass": (alike or [systems[-1]])[0].body.center_of_mass}


TENSORS = tuple(np.diag([1.0 + k, 2.0 + 0.5 * k, 1.7 + k]).tolist() for k in range(3))
BODIES = tuple(case(f"body-{k}", {"gravity": GRAVITY}, 2.0, TENSORS[k]) for k in range(3))
HELD = tuple(
    case(f"held-{k}", {"gravity": GRAVITY, "pivot": [0.3, 0.1 * k, -0.2]}, 2.0, TENSORS[k])
    for k in range(3)
)


def with_center(one: Case, *center: float) -> Case:
    body = replace(one.system.body, center_of_mass=np.array(center))
    return replace(one, system=replace(one.system, bodies=(body,)))


TOPS = tuple(
    with_center(
        case(f"top-{k}", {"gravity": GRAVITY, "pivot": [0.3, 0.1 + k // 2, -0.2]}, 2.0 + k),
        *(0.1 * k, 0.2, k - 0.3),
    )
    for k in range(4)
)
HEAVY = tuple(case(f"heavy-{k}", {"gravity": GRAVITY}, 9.0, TENSORS[k]) for k in (2, 0))

WRONG: dict[str, tuple[Engine, tuple[Case, ...], str]] = {
    name: (last_given(name), CASES, text)
    for name, text in (
        ("gravity", "where no gravity is requested, that of a system loaded before is kept"),
        ("damping", "where no damping is requested, that of a system loaded before is kept"),
        ("torque_body", "where no torque in body axes is requested, that of a system loaded"),
        ("pivot", "where no pivot is requested, that of a system loaded before is kept"),
    )
}
WRONG |= {
    "first gravity": (
        of_load(lambda loads: {"gravity": loads[0].gravity}),
        CASES[1:],
        "the gravity of the first system that was loaded is kept for all",
    ),
    "mass": (
        of_body(lambda s: {"mass": s[-2:][0].body.mass}),
        CASES,
        "the mass of the system loaded before is kept",
    ),
    "center": (
        of_body(lambda s: {"center_of_mass": s[-2:][0].body.center_of_mass}),
        CASES,
        "the centre of mass of the system loaded before is kept",
    ),
    "inertia": (
        of_body(lambda s: {"inertia": s[-2:][0].body.inertia}),
        BODIES,
        "the inertia of the system loaded before is kept",
    ),
    "by mass": (
        of_body(same_mass),
        (*BODIES, *HEAVY),
        "the inertia is found again by the mass: a system has that of the first with this mass "
        "that was loaded before",
    ),
    "inverse": (
        old_inverse,
        BODIES,
        "the inverse of the inertia of the system loaded before is kept",
    ),
    "inverse by mass": (
        of_equation(of_one_mass, True, "solve"),
        (*HELD, *BODIES, *HEAVY),
        "the inverse of the inertia is found again by the mass: ",
    ),
    "inverse by mass and support": (
        of_equation(of_one_support, True, "solve"),
        (HELD[0], *BODIES, *HELD[1:], *HEAVY),
        "the inverse of the inertia is found again by the mass and by whether it is pivoted: ",
    ),
    "gyroscopic": (
        of_equation(lambda one, other: True, False, "spin"),
        (*HELD, *BODIES),
        "the inertia in the gyroscopic term of the system loaded before is kept",
    ),
    "by pivot": (
        of_body(of_one_pivot),
        (*TOPS, *BODIES),
        "the centre of mass is found again by the pivot: ",
    ),
    "of a pivoted body": (
        of_equation(of_one_support, True, "solve", "spin"),
        (*HELD, *BODIES, *HEAVY),
        "the inertia (about the pivot, if any) is found again by the mass and by whether",
    ),
}


def scenes(engine: Engine, cases: Sequence[Case], at_rest: str = "") -> Iterator[Scene]:
    """Each case loaded after the one before, then another system, then the case again.

    at_rest: the case of which some states do not turn, those that are looked at first.
    """
    loads = Loads()

    def loaded(system: System, states: State) -> Acceleration:
        loads.add(system)
        return engine([*loads.before.systems[: loads.before.count + 1]], states)

    for one in cases:
        states = random_states(one, 30, [1])
        if one.name == at_rest:
            states.angular_velocity[np.linspace(0, 29, FEW).round().astype(int)] = 0.0
        evidence, before = {}, {}
        found = loaded(one.system, states)
        evidence[FORWARD] = of_forward_dynamics(one.system, states, found)
        before[""] = loads.before
        loaded(OTHERS[one.system.load.pivot is not None].system, states)
        again = loaded(one.system, states)
        evidence[RELOADED] = of_forward_dynamics(one.system, states, again)
        before[RELOADED] = loads.before
        features = features_of(one.system, one.initial)
        yield Scene(one.name, one.system, features, evidence, before=before)


def causes(engine: Engine, cases: Sequence[Case], at_rest: str = "") -> dict[tuple[str, str], str]:
    across = Across()
    every = list(scenes(engine, cases, at_rest))
    for one in every:
        across.add(one)
    wrong = [(one.name, k) for one in every for k, e in one.evidence.items() if e.clear]
    return {where: "; ".join(equation_causes(across, *where)) for where in wrong}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_kept_is_named_on_every_scenario_that_it_makes_wrong(name: str) -> None:
    """Caught: a constant, another inertia or nothing known, on each scenario another."""
    engine, cases, phrase = WRONG[name]
    found = causes(engine, cases)
    assert len(found) > 2
    assert all(text.startswith(phrase) for text in found.values()), found


def test_states_that_show_nothing_rule_nothing_out() -> None:
    """Caught: the damping of another system not named, as a body does not turn at a few states."""
    engine, cases, phrase = WRONG["damping"]
    wrong = [name for name, _ in causes(engine, cases)]
    found = causes(engine, cases, at_rest=wrong[0])
    assert wrong[0] in {name for name, _ in found}
    assert all(text.startswith(phrase) for text in found.values()), found


def test_a_constant_that_is_no_other_systems_is_not_called_kept() -> None:
    """The gravity of the first scenario acts on all, and on the very first one too."""
    constant = np.array(GRAVITY)
    found = causes(of_load(lambda loads: {"gravity": constant}), CASES[1:4])
    assert found
    assert not any("loaded before" in text for text in found.values())


def test_a_driver_records_what_was_loaded_before() -> None:
    driver = driver_of("reference", ReferenceAdapter())
    for one in (CASES[0], CASES[1], CASES[0], CASES[2]):
        driver.request(one, "model", state=one.initial, before=one.initial)
    assert driver.before.last is CASES[0].system
    assert [*driver.before.latest_first()] == [CASES[k].system for k in (0, 1, 0)]


def test_the_torque_of_steps_is_looked_for_as_well() -> None:
    """Where no forward dynamics are offered, steps are all that shows what is kept."""
    across = Across()
    for one in scenes(last_given("gravity"), CASES):
        own = {"steps of euler": one.evidence[FORWARD], "x": one.evidence[RELOADED]}
        before = {"": one.before[""], "x": one.before[RELOADED]}
        across.add(replace(one, evidence=own, before=before))
    assert "gravity" in across.left_over("driven", "steps of euler")
    assert across.left_over("falling", "steps of euler") == ""
