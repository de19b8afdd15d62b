"""Equations that are wrong at some states: which these are, by omega, by sizes and by the place."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from test_causes import causes_over
from wrong_equations import CASES, TENSOR, case, gyroscopic, with_torque

from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.evidence import ALONG, FORWARD, of_forward_dynamics
from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.wording.conditions import only_where
from omegadot.diagnosis.wording.features import features_of
from omegadot.gates.bounds.scales import norm
from omegadot.gates.states.equation import random_states
from omegadot.reference_impl.energy import rotational_kinetic_energy
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.loads import applied_torque
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import rotate_inverse
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Acceleration, Array, State, System

Where = Callable[[System, State], NDArray[np.bool_]]
Equation = Callable[[System, State], Acceleration]
LIGHT = case("light", {}, 0.3, 0.2 * np.array(TENSOR))
SEVERAL = (*CASES[:2], LIGHT)


def sizes(x: State) -> Array:
    return np.abs(x.angular_velocity)


def missing(where: Where, of: Callable[[System, State], Array]) -> Equation:
    """The right equation, at these states without a torque."""

    def found(system: System, states: State) -> Acceleration:
        torque = of(system, states) + 0.0 * states.angular_velocity
        return with_torque(system, states, np.where(where(system, states)[:, None], -torque, 0.0))

    return found


def reaction(system: System, states: State) -> Array:
    return -gyroscopic(system, states)


def near_z(_: System, x: State) -> NDArray[np.bool_]:
    return np.asarray(np.max(sizes(x)[:, :2], axis=-1) < 0.3 * sizes(x)[:, 2])


def near_z_or_still(system: System, x: State) -> NDArray[np.bool_]:
    return near_z(system, x) | ~np.any(x.angular_velocity, axis=-1)


def x_below_y(_: System, x: State) -> NDArray[np.bool_]:
    return np.asarray(sizes(x)[:, 0] < 0.5 * sizes(x)[:, 1])


def kinetic(system: System, x: State) -> Array:
    moving = 0.5 * float(system.body.mass) * norm(x.linear_velocity) ** 2
    return np.asarray(rotational_kinetic_energy(system, x) + moving)


def momentum(system: System, x: State) -> Array:
    return norm(x.angular_velocity @ np.asarray(moving_inertia(system)).T)


NEAR_Z = "the larger of omega's other components over |omega_z| is below a limit between"
CONDITIONS: dict[str, tuple[Where, str, float]] = {  # with the limit
    "near z": (near_z, NEAR_Z, 0.3),
    "x below y": (x_below_y, "|omega_x| over |omega_y| is below a limit between", 0.5),
    "energy": (lambda s, x: kinetic(s, x) < 8.0, "the kinetic energy is below a limit", 8.0),
    "energy over mass": (
        lambda s, x: kinetic(s, x) < 8.0 * float(s.body.mass),
        "the kinetic energy over the mass is below a limit",
        8.0,
    ),
    "momentum": (
        lambda s, x: momentum(s, x) > 4.0,
        "the size of the angular momentum is above a limit",
        4.0,
    ),
    "omega-dot": (
        lambda s, x: norm(forward_dynamics(s, x).angular) > 2.0,
        "|omega-dot| is above a limit",
        2.0,
    ),
}


@pytest.mark.parametrize("name", CONDITIONS)
def test_the_condition_under_which_a_term_is_missing_is_named(name: str) -> None:
    """Caught: an infinite ratio, of a state with no z component, that hides what sorts the rest."""
    where, phrase, limit = CONDITIONS[name]
    drawn = [random_states(one, 60, [1]) for one in SEVERAL]
    assert any(np.any((sizes(x)[:, 2] == 0.0) & np.any(sizes(x), axis=-1)) for x in drawn)
    texts = set(causes_over(missing(where, reaction), SEVERAL).values())
    assert len(texts) == 1
    (text,) = texts
    assert text.startswith(f"the gyroscopic term is missing, but only where {phrase}")
    below, above = text.partition(" between ")[2].split(" and ")
    assert float(below) <= limit <= float(above.split()[0])


@pytest.mark.parametrize("where", [near_z, near_z_or_still, x_below_y])
def test_a_state_without_a_ratio_is_on_either_side_of_a_limit(where: Where) -> None:
    """Of an omega of zero an engine that compares by < does another thing than one by <=."""
    driven = CASES[5:7]
    still = [~np.any(random_states(one, 60, [1]).angular_velocity, axis=-1) for one in driven]
    assert all(map(np.any, still))
    texts = causes_over(missing(where, applied_torque), driven)
    assert len(texts) == 2
    for text in texts.values():
        assert "the applied torque is missing, but only where " in text
        assert ("over |omega_y| is below" if where is x_below_y else NEAR_Z) in text


def test_a_ratio_that_few_states_have_sorts_nothing() -> None:
    """Of most omega is along z and has none of x to y: that a limit sorts the rest is chance."""
    states = random_states(CASES[0], 200, [1])[40:100]
    w, sound = states.angular_velocity, np.ones(60, bool)
    sound[::15] = False
    w[:, :2] = 0.0
    w[::15, :2] = w[::15, 2:] * [0.05, 0.2]
    w[5::15, :2] = w[5::15, 2:] * [5.0, 10.0]
    assert only_where([(CASES[0].system, states, sound)]) == ""


def test_a_quotient_by_zero_is_no_limit() -> None:
    """Caught: "below a limit between 0 and 1.8e308", of states of which all sound ones turn so."""
    states = random_states(CASES[0], 200, [1])[40:100]
    sound = np.arange(60) % 3 == 0
    states.angular_velocity[sound, 1] = 0.0
    assert "over" not in only_where([(CASES[0].system, states, sound)])


@pytest.mark.parametrize("first", [20, 45])
def test_the_place_in_a_request_from_which_on_omega_dot_is_zero_is_named(first: int) -> None:
    def found(system: System, states: State) -> Acceleration:
        true = forward_dynamics(system, states)
        early = np.arange(len(true.angular)) < first
        return replace(true, angular=np.where(early[:, None], true.angular, 0.0))

    place = "the number of the state among those that are requested together"
    due = f"omega-dot is zero, but only where {place} is above a limit between {first} and"
    assert set(causes_over(found, CASES[:3]).values()) == {f"{due} {first + 1}"}


def test_a_few_states_along_a_trajectory_have_the_condition_of_the_drawn_ones() -> None:
    def where(_: System, x: State) -> NDArray[np.bool_]:
        return np.asarray(sizes(x)[:, 0] > 0.9)

    one, found = CASES[0], missing(where, reaction)
    path = step_body(SCHEMES["rk4-quaternion"], one.system, one.initial, 0.02, 200, 20)[1]
    states = {FORWARD: random_states(one, 60, [1]), ALONG: path}
    assert only_where([(one.system, path, ~where(one.system, path))]) == ""
    evidence = {
        source: of_forward_dynamics(one.system, x, found(one.system, x))
        for source, x in states.items()
    }
    across = Across()
    features = features_of(one.system, one.initial)
    across.add(Scene(one.name, one.system, features, evidence))
    texts = [across.cause(one.name, source) for source in (FORWARD, ALONG)]
    due = "the gyroscopic term is missing, but only where |omega_x| is above a limit"
    assert [text.partition(" between ")[0] for text in texts] == [due, due]


def near_identity(system: System, x: State) -> Array:
    """(n,) rad, the turn from the identity."""
    return 2.0 * np.arccos(np.clip(np.abs(x.orientation[:, 0]), 0.0, 1.0))


def in_body(x: State, load: Array, twice: float) -> Array:
    """``1 - [t] + twice [t]^2`` times a load in world axes, t the turn from the identity."""
    half = x.orientation * np.where(x.orientation[:, :1] < 0.0, -1.0, 1.0)
    size = norm(half[:, 1:])[:, None]
    t = half[:, 1:] / size * 2.0 * np.arctan2(size, half[:, :1])
    once = -np.cross(t, load + 0.0 * t)
    return np.asarray(load + once - twice * np.cross(t, once))


@pytest.mark.parametrize(("twice", "order"), [(0.0, "first"), (0.5, "second")])
def test_a_series_for_small_turns_of_loads_is_named(twice: float, order: str) -> None:
    """Caught: "omega-dot is off at some states", as what is off is little at the least turns."""

    def found(system: System, x: State) -> Acceleration:
        load, arm = system.load, np.asarray(lever(system)) * (system.load.pivot is not None)
        pull = float(system.body.mass) * np.asarray(load.gravity)
        by = [
            in_body(x, one, twice) - rotate_inverse(x.orientation, one)
            for one in (np.asarray(load.torque_world), pull)
        ]
        small = near_identity(system, x)[:, None] < 0.25
        return with_torque(system, x, np.where(small, by[0] + np.cross(arm, by[1]), 0.0))

    texts = set(causes_over(found).values())
    assert len(texts) == 1
    start = f"loads in world axes are turned into the body by a series of the {order} order, but"
    assert texts.pop().startswith(f"{start} only where the angle from the identity is below")


def test_an_error_that_fades_has_no_limit_where_it_is_seen_no_more() -> None:
    """Caught: a limit at the turn below which an error of the sixth power is within rounding."""

    def found(system: System, x: State) -> Acceleration:
        off = 1e-8 * near_identity(system, x)[:, None] ** 6 * np.ones(3)
        return with_torque(system, x, off)

    assert not any("the angle from the identity" in text for text in causes_over(found).values())
