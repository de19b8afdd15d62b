"""What is stated where no cause fits is true on every scenario that it is stated of."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from wrong_equations import CASES, GRAVITY, PIVOT, case, with_torque

from omegadot.diagnosis.equations.dependence import dependence_text, powers_over
from omegadot.diagnosis.equations.describe import off_of, off_over, off_text
from omegadot.diagnosis.equations.evidence import FORWARD, of_forward_dynamics
from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.equations.known import kinds_off, known_over
from omegadot.diagnosis.wording.features import Features, features_of, in_common
from omegadot.gates.bounds.scales import norm
from omegadot.gates.case import Case
from omegadot.gates.states.equation import random_states
from omegadot.harness.requests.scaled import STATES, doubled
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import rotation_matrix
from omegadot.reference_impl.system import Acceleration, State, System

Equation = Callable[[System, State], Acceleration]


def scenes(equation: Equation, cases: Sequence[Case]) -> list[Scene]:
    """With the answers of each size doubled."""
    found = []
    for one in cases:
        states = random_states(one, 60, [1])
        evidence = of_forward_dynamics(one.system, states, equation(one.system, states))
        scaled = {
            what: of_forward_dynamics(system, few, equation(system, few))
            for what, system, few in doubled(one.system, states[:STATES])
        }
        features = features_of(one.system, one.initial)
        found.append(Scene(one.name, one.system, features, {FORWARD: evidence}, scaled=scaled))
    return found


def known(every: Sequence[Scene], name: str) -> str:
    own = next(one for one in every if one.name == name)
    return known_over(every, [], FORWARD, "", kinds_off(own, FORWARD))


MIXED = (
    *(case(f"fast-{k}", {"damping": 0.1 + k}, 1.0 + k) for k in range(3)),
    *(case(f"top-{k}", {"pivot": PIVOT, "gravity": GRAVITY}, 1.0 + k) for k in range(3)),
)


def odd_pull(system: System, states: State) -> Acceleration:
    """A pull without a name: it turns a pivoted body and moves a free one."""
    pull = np.sin(3.0 * np.arange(3) + 1.0) * np.cosh(states.orientation[:, :1])
    if system.load.pivot is not None:
        return with_torque(system, states, pull)
    true = forward_dynamics(system, states)
    return replace(true, linear=true.linear + pull)


def test_of_a_free_body_whose_omega_dot_is_right_nothing_is_said_of_it() -> None:
    """Caught: what is seen of pivoted bodies, "goes as the size^-2" among it."""
    every = scenes(odd_pull, MIXED)
    free, pivoted = known(every, "fast-0"), known(every, "top-0")
    assert free.startswith("the linear acceleration is off")
    assert "omega-dot" not in free
    assert "size^" not in free
    assert pivoted.startswith("omega-dot is off")
    assert "linear" not in pivoted
    assert "size^" in pivoted


def test_a_power_law_takes_three_scenarios_and_none_against_it() -> None:
    """Caught: a law of two points, and one that a scenario has no power for."""
    one, two = {"the mass": -1.0, "the size": 0.0}, {"the mass": None, "the size": 0.0}
    assert dependence_text(powers_over([one])) == (
        "twice the mass makes it 0.5 times as large, and it is the same with twice the size"
    )
    assert dependence_text(powers_over([one] * 3)) == (
        "it goes as the mass^-1, and it does not depend on the size"
    )
    assert dependence_text(powers_over([one, one, two])) == "it does not depend on the size"


def test_the_power_of_omega_is_left_out_where_one_scenario_has_none() -> None:
    """Caught: the exponent of those scenarios that have one."""

    def odd(system: System, states: State) -> Acceleration:
        w = states.angular_velocity
        size = np.linalg.norm(w, axis=-1, keepdims=True)
        more = np.sin(size) if float(system.body.mass) > 2.0 else size
        return with_torque(system, states, -0.1 * more * w)

    whole = [off_of(one.evidence[FORWARD], "angular") for one in scenes(odd, MIXED[:3])]
    found = [one for one in whole if one is not None]
    assert [bool(np.isfinite(one.power or np.nan)) for one in found] == [True, True, False]
    low, both = off_over(found[:2]), off_over(found)
    assert low is not None
    assert both is not None
    assert "|omega|^2" in off_text("omega-dot", low)
    assert "^" not in off_text("omega-dot", both)


def test_axes_that_are_off_by_turns_are_not_said_to_be_off_together() -> None:
    """Caught: "in x and y alone" of scenarios each of which is off in one."""

    def odd(system: System, states: State) -> Acceleration:
        true = forward_dynamics(system, states)
        axis = int(float(system.body.mass) > 1.5)
        return replace(true, angular=true.angular + 0.1 * np.eye(3)[axis])

    found = [off_of(one.evidence[FORWARD], "angular") for one in scenes(odd, MIXED[:2])]
    over = off_over([one for one in found if one is not None])
    assert over is not None
    assert off_text("omega-dot", over).startswith("omega-dot is off in x or y alone")


def test_a_size_that_sorts_two_of_many_scenarios_is_chance() -> None:
    """Caught: "only where |omega| at the start is below a limit", of two in twenty-one."""
    draw = np.random.default_rng(1)
    bodies = [case(f"b-{k}", {}, float(m)) for k, m in enumerate(draw.uniform(1.0, 2.0, 21))]
    features = sorted(
        (features_of(one.system, one.initial) for one in bodies), key=lambda f: f.sizes["the mass"]
    )
    assert in_common(features[:2], features[2:]) == []
    assert any("the mass is below" in text for text in in_common(features[:5], features[5:]))


def test_what_is_off_at_other_shares_of_the_states_has_both() -> None:
    def odd(system: System, states: State) -> Acceleration:
        least = 4.0 * float(system.body.mass)
        fast = np.linalg.norm(states.angular_velocity, axis=-1, keepdims=True) > least
        return with_torque(system, states, np.where(fast, np.sin(states.angular_velocity), 0.0))

    found = [off_of(one.evidence[FORWARD], "angular") for one in scenes(odd, CASES[:3])]
    over = off_over([one for one in found if one is not None])
    assert over is not None
    assert f"at {100 * over.share[0]:.0f} to {100 * over.share[1]:.0f} % of the states" in off_text(
        "omega-dot", over
    )


def test_an_inertia_of_another_attitude_is_said_to_change_with_it() -> None:
    """Caught: "does not depend on the speed", of what is zero at the identity and goes as omega^2:
    the linear velocity was meant, and the attitude not looked at.
    """

    def odd(system: System, states: State) -> Acceleration:
        w = states.angular_velocity
        lean = rotation_matrix(states.orientation)[:, :, 0] * norm(w)[:, None] * w[:, [1, 2, 0]]
        return with_torque(system, states, lean)

    text = known(scenes(odd, MIXED[:3]), "fast-0")
    assert "it changes with the attitude" in text
    assert "does not depend on the linear velocity, the position, the mass" in text
    assert "speed" not in text

    def steady(system: System, states: State) -> Acceleration:
        w = states.angular_velocity
        return with_torque(system, states, norm(w)[:, None] * np.sin(w[:, [1, 2, 0]]))

    text = known(scenes(steady, MIXED[:3]), "fast-0")
    assert "does not depend on the linear velocity, the position, the attitude" in text
    assert "changes with" not in text


def test_unequal_moments_are_named_so() -> None:
    """Caught: "above a limit between 1 and 1.000001", of bodies that are all but one no sphere."""

    def body(spread: float) -> Features:
        system = case("one", {}, 1.0).system
        tensor = np.diag([1.0, 1.0, 1.0 + spread])
        own = replace(system, bodies=(replace(system.body, inertia=tensor),))
        return features_of(own, case("one", {}, 1.0).initial)

    unequal, equal = [body(s) for s in (1e-6, 1e-3, 0.1, 0.5)], [body(0.0), body(1e-16)]
    assert in_common(unequal, equal) == ["the moments of inertia are unequal"]
    assert in_common(equal, unequal) == ["the moments of inertia are equal"]
