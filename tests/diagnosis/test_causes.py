"""Causes of faults that the catalogue does not have: named, or nothing, over several scenarios."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pytest
from wrong_equations import (
    BODY_TORQUE,
    CASES,
    EQUATIONS,
    GRAVITY,
    PIVOT,
    TENSOR,
    WORLD_TORQUE,
    case,
    gyroscopic,
    mirrored_center,
    with_torque,
)

from omegadot.diagnosis.equations.across import Across, Scene
from omegadot.diagnosis.equations.evidence import FORWARD, of_forward_dynamics, of_inverse_dynamics
from omegadot.diagnosis.equations.wrong_equation import equation_causes
from omegadot.diagnosis.equations.wrong_inverse import WrongInverse
from omegadot.diagnosis.equations.wrong_torque import torque_causes
from omegadot.diagnosis.stepping.trace import Trace, trace_causes
from omegadot.diagnosis.stepping.vanishing.jumps import jump_cause
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import VanishingSteps, vanishing_steps
from omegadot.diagnosis.wording.digits import factor, number
from omegadot.diagnosis.wording.features import features_of
from omegadot.diagnosis.wording.laws import law_of, power_laws
from omegadot.gates.case import Case
from omegadot.gates.states.equation import random_acceleration, random_states
from omegadot.gates.steps.probe import DOUBLE, Probe
from omegadot.reference_impl.loads import applied_torque, damping_torque
from omegadot.reference_impl.motion import forward_dynamics, inverse_dynamics
from omegadot.reference_impl.rotations import rotate_inverse
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import stack, step_body
from omegadot.reference_impl.system import Acceleration, Array, State, System


def causes_over(found: Any, cases: tuple[Case, ...] = CASES) -> dict[str, str]:
    """The cause on every scenario on which this equation is not the right one."""
    across, wrong = Across(), list[str]()
    for one in cases:
        states = random_states(one, 60, [1])
        evidence = of_forward_dynamics(one.system, states, found(one.system, states))
        features = features_of(one.system, one.initial)
        across.add(Scene(one.name, one.system, features, {FORWARD: evidence}))
        wrong += [] if np.all(evidence.sound) else [one.name]
    return {name: "; ".join(equation_causes(across, name, FORWARD)) for name in wrong}


@pytest.mark.parametrize("name", EQUATIONS)
def test_a_wrong_equation_is_named_on_every_scenario_that_shows_it(name: str) -> None:
    found, phrase = EQUATIONS[name]
    causes = causes_over(found)
    assert causes
    assert all(phrase in text for text in causes.values()), causes


def test_a_wrong_omega_dot_is_named_where_the_linear_accelerations_are_right() -> None:
    """On a pivot they follow from omega-dot; an engine may compute them another way."""

    def angular_alone(system: System, states: State) -> Acceleration:
        wrong = with_torque(system, states, gyroscopic(system, states))
        return replace(forward_dynamics(system, states), angular=wrong.angular)

    causes = causes_over(angular_alone)
    assert len(causes) == len(CASES)
    assert set(causes.values()) == {"the gyroscopic term is missing"}


def test_an_omega_dot_that_is_constant_here_and_not_there_is_no_constant() -> None:
    def odd(system: System, states: State) -> Acceleration:
        """Constant without loads; with them wrong in a way that has no name."""
        true = forward_dynamics(system, states)
        if system.load.pivot is None:
            return replace(true, angular=0.0 * true.angular + [0.3, -0.1, 0.2])
        return replace(true, angular=true.angular + states.angular_velocity**3)

    free = case("free", {})
    top = case("top", {"gravity": [0.0, 0.0, -9.0], "pivot": PIVOT})
    texts = causes_over(odd, (free, top))
    assert len(texts) == 2
    assert not any("the same at every state" in text for text in texts.values())
    assert "the same at every state" in causes_over(odd, (free,))["free"]


def test_two_causes_that_one_scenario_cannot_distinguish_are_both_named() -> None:
    alone = case("alone", {"gravity": [0.0, 0.0, -9.0], "pivot": PIVOT})
    (text,) = causes_over(mirrored_center, (alone,)).values()
    assert text.startswith("either gravity has the wrong sign, or ")
    assert "the centre of mass is mirrored" in text


def test_a_cause_that_another_scenario_contradicts_is_not_named() -> None:
    alone = case("alone", {"gravity": [0.0, 0.0, -9.0], "pivot": PIVOT})
    (text,) = causes_over(mirrored_center, (alone, CASES[1])).values()
    assert "gravity has the wrong sign" not in text


def test_numbers_have_digits_that_differ() -> None:
    assert factor(1.0 + 1e-12) == "1 + 1e-12"
    assert number(0.1, float(np.float32(0.1))) != number(float(np.float32(0.1)), 0.1)


def test_damping_in_inverse_dynamics() -> None:
    system, states = CASES[2].system, random_states(CASES[2], 60, [1])
    requested = random_acceleration(system, states, [2])
    true = inverse_dynamics(system, states, requested)
    less = true - damping_torque(system, states)
    (text,) = torque_causes(system, states, requested, less)
    assert "leave out what damping takes up" in text


def test_a_state_at_rest_hides_no_cause_of_inverse_dynamics() -> None:
    """There no torque is due, of any size: what is left out there has no share."""
    system, states = CASES[2].system, random_states(CASES[2], 60, [1])
    requested = random_acceleration(system, states, [2])
    for field in (states.angular_velocity, states.linear_velocity, requested.angular):
        field[0] = 0.0
    less = inverse_dynamics(system, states, requested) - damping_torque(system, states)
    (text,) = torque_causes(system, states, requested, less)
    assert "leave out what damping takes up" in text


def test_a_torque_that_overflows_has_no_share_of_any_term() -> None:
    """Caught: a ValueError of rounding what is not finite, reported as a defect."""
    system, states = CASES[2].system, random_states(CASES[2], 60, [1])
    requested = random_acceleration(system, states, [2])
    for size in (np.inf, np.nan, 1e308):
        torque = np.full_like(states.angular_velocity, size)
        with np.errstate(all="ignore"):
            assert torque_causes(system, states, requested, torque) == []


BOTH_TORQUES = {"torque": [BODY_TORQUE, WORLD_TORQUE]}


def of_world(system: System, states: State) -> Array:
    return rotate_inverse(states.orientation, system.load.torque_world)


@pytest.mark.parametrize(
    ("taken", "loads", "text"),
    [
        (
            lambda system, states: damping_torque(system, states) + applied_torque(system, states),
            [{"damping": 0.3}, {"torque": BODY_TORQUE}, {"damping": 0.3} | BOTH_TORQUES],
            "leave out the loads that act: damping and torque",
        ),
        (
            applied_torque,
            [{"torque": WORLD_TORQUE}, BOTH_TORQUES],
            "leave out what the applied torque takes up: it is counted among what is given",
        ),
        (
            of_world,
            [{"torque": WORLD_TORQUE}, BOTH_TORQUES],
            "leave out what the torque in world axes takes up: it is counted among what is given",
        ),
        (
            of_world,
            [{"torque": WORLD_TORQUE}],
            "leave out what the applied torque takes up: it is counted among what is given",
        ),
    ],
)
def test_what_inverse_dynamics_leave_out_on_several_scenarios_is_one_cause(
    taken: Callable[[System, State], Array], loads: list[dict[str, Any]], text: str
) -> None:
    """Where one of the loads acts alone, several fit, which the other scenarios tell apart."""
    found, names = WrongInverse(), [f"scenario-{k}" for k in range(len(loads))]
    for name, load in zip(names, loads, strict=True):
        one = case(name, load)
        states = random_states(one, 60, [1])
        requested = random_acceleration(one.system, states, [2])
        torque = inverse_dynamics(one.system, states, requested) - taken(one.system, states)
        features = features_of(one.system, one.initial)
        found.add(name, of_inverse_dynamics(one.system, states, requested, torque), features)
    assert {tuple(found.causes(name)) for name in names} == {(f"inverse dynamics {text}",)}


@pytest.mark.parametrize(
    ("on", "condition"),
    [
        (lambda s: not np.any(s.body.inertia[0, 1:]), "the inertia has no products"),
        (lambda s: s.load.pivot is not None, "the body is pivoted"),
    ],
)
def test_what_inverse_dynamics_leave_out_on_some_bodies_is_named_with_them(
    on: Callable[[System], bool], condition: str
) -> None:
    """Caught: the same of every body, though inverse dynamics of most are right."""
    found, names = WrongInverse(), list[str]()
    diagonal = np.diag([1.0, 1.6, 2.1]).tolist()
    more = ({}, {"damping": 0.3}, {"gravity": GRAVITY}, {"torque": BODY_TORQUE})
    loads = [{**load, **held} for load in more for held in ({}, {"pivot": PIVOT})]
    for k, (load, tensor) in enumerate(product(loads, (TENSOR, diagonal))):
        one = case(f"scenario-{k}", load, tensor=tensor)
        states = random_states(one, 60, [1])
        requested = random_acceleration(one.system, states, [2])
        torque = inverse_dynamics(one.system, states, requested)
        if on(one.system):
            names.append(one.name)
            torque = torque - gyroscopic(one.system, states)
        evidence = of_inverse_dynamics(one.system, states, requested, torque)
        found.add(one.name, evidence, features_of(one.system, one.initial))
    text = f"inverse dynamics leave out the gyroscopic term, but only where {condition}"
    assert len(names) == 8
    assert [found.causes(name) for name in names] == [[text]] * len(names)


def steps_that_end(after: Callable[[State], State]) -> VanishingSteps:
    """Of semi-implicit Euler, with something made of the end of each step."""
    one = CASES[1]
    states = random_states(one, 12, [1])
    rate = 4.0 * float(np.max(np.abs(states.angular_velocity))) + 1.0
    steps = np.full((12, 1), DOUBLE.radians / rate) / 2.0 ** np.arange(DOUBLE.count)

    def end(k: int, h: float) -> State:
        scheme = SCHEMES["semi-implicit-euler"]
        return after(step_body(scheme, one.system, states[k], h, 1, 1)[1][-1])

    stepped = stack([stack([end(k, h) for h in steps[k]]) for k in range(12)])
    return vanishing_steps(one.system, Probe(states, steps), stepped)


def test_a_limit_on_the_speed_is_seen_in_steps_of_no_length() -> None:
    def held(after: State) -> State:
        speed = float(np.linalg.norm(after.linear_velocity))
        return replace(after, linear_velocity=after.linear_velocity * min(1.0, 0.5 / speed))

    assert jump_cause(steps_that_end(held)) == "the linear velocity is held below 0.5 m/s"


def test_an_omega_in_fixed_point_is_one_of_whole_multiples() -> None:
    """Caught: "rounded to 8 decimals", which every multiple of 1/256 is."""

    def fixed(after: State) -> State:
        return replace(after, angular_velocity=np.round(256.0 * after.angular_velocity) / 256.0)

    found = steps_that_end(fixed).rounded
    assert found == "omega is rounded to multiples of 2^-8 in each step"


def test_a_trace_has_causes() -> None:
    one = CASES[5]
    wrong = replace(one.system, load=replace(one.system.load, torque_body=np.zeros(3)))
    times, state = step_body(SCHEMES["rk4-quaternion"], wrong, one.initial, 1e-3, 1000, 20)
    nothing = np.zeros(len(times))
    found = trace_causes(one.system, Trace(times, state, nothing, nothing))
    assert found == ["the applied torque is missing"]
    right = step_body(SCHEMES["rk4-quaternion"], one.system, one.initial, 1e-3, 1000, 20)[1]
    assert trace_causes(one.system, Trace(times, right, nothing, nothing)) == []


@pytest.mark.parametrize(
    ("change", "phrase"),
    [
        (
            lambda torque: torque * np.array([1.0, -1.0, 1.0]),
            "in other axes: x, y, z hold x, -y, z",
        ),
        (lambda torque: 1000.0 * torque, "report the torque scaled by 1000"),
    ],
)
def test_a_torque_of_inverse_dynamics_in_other_axes_or_units_is_named(
    change: Any, phrase: str
) -> None:
    system = CASES[-1].system
    states = random_states(CASES[-1], 60, [1])
    requested = random_acceleration(system, states, [1])
    wrong = change(inverse_dynamics(system, states, requested))
    (text,) = torque_causes(system, states, requested, wrong)
    assert phrase in text


def test_one_component_of_the_gyroscopic_term_is_named_in_inverse_dynamics() -> None:
    system = CASES[-1].system
    states = random_states(CASES[-1], 60, [1])
    requested = random_acceleration(system, states, [1])
    wrong = inverse_dynamics(system, states, requested) - gyroscopic(system, states) * [1, 0, 0]
    (text,) = torque_causes(system, states, requested, wrong)
    assert text == "inverse dynamics leave out the x component of the gyroscopic term"


@pytest.mark.parametrize(
    ("rounded", "text"),
    [
        (np.float16, "rounded to half precision"),
        (lambda x: float(f"{x:.3g}"), "rounded to 3 digits"),
        (lambda x: 1.01 * x, "scaled by 1.01"),
    ],
)
def test_numbers_that_are_rounded_have_a_law(rounded: Any, text: str) -> None:
    """Caught: a list of numbers, one a scenario, in place of what makes each of them."""
    requested = np.random.default_rng(0).lognormal(0.0, 3.0, 14)
    pairs = [(np.array([x]), np.array([float(rounded(x))])) for x in requested]
    assert law_of(pairs, "the damping", "N m s/rad") == f"the damping is {text}"


def test_a_rate_of_decay_that_goes_as_a_size_keeps_its_sign() -> None:
    """Caught: "omega-dot has c omega in it, where c is 3 times the damping over the trace"."""
    damped = [
        case(f"damped-{k}", {"damping": d}, 1.0, np.diag(m).tolist())
        for k, (d, m) in enumerate(
            (
                (0.3, (1.0, 1.6, 2.1)),
                (1.7, (0.7, 1.1, 1.3)),
                (29.0, (6.0, 15.0, 18.0)),
                (0.1, (30.0, 40.0, 60.0)),
                (4.0, (0.2, 0.3, 0.4)),
                (0.02, (2.0, 2.5, 2.7)),
            )
        )
    ]
    rates = [3.0 * float(c.system.load.damping) / np.trace(c.system.body.inertia) for c in damped]
    features = [features_of(one.system, one.initial) for one in damped]
    made = power_laws("omega-dot has -0.5 omega in it", features, np.array(rates))
    texts = [text for text, due in made if np.allclose(due, rates)]
    assert any("has -c omega in it, where c is 3 times the damping over" in text for text in texts)
