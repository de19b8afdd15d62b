"""Causes made of a term and what is done to it, what is known where none fits, and lost orders."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from test_causes import causes_over
from wrong_equations import CASES, GRAVITY, PIVOT, WORLD_TORQUE, case, gyroscopic, with_torque

from omegadot.diagnosis.equations.dependence import dependence
from omegadot.diagnosis.equations.evidence import Evidence, of_forward_dynamics
from omegadot.diagnosis.stepping.explicit_schemes import on_quaternion
from omegadot.diagnosis.stepping.step_orders import order_lost
from omegadot.gates.bounds.scales import EPS, norm
from omegadot.gates.states.equation import random_states
from omegadot.gates.steps.probe import DOUBLE, Probe
from omegadot.harness.requests.scaled import STATES, doubled
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import damping_torque
from omegadot.reference_impl.rotations import rotate, rotation_matrix
from omegadot.reference_impl.schemes import SCHEMES, Scheme
from omegadot.reference_impl.schemes.scheme import every_channel
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array, State, System

DAMPED, DRIVEN = CASES[2:5], CASES[5:7]
Of = Callable[[System, State], Array]


def gyro(system: System, states: State) -> Array:
    return -gyroscopic(system, states)


def spoiled(of: Of, change: Callable[[Array, State], Array]) -> Callable[..., Acceleration]:
    """One torque of the right equation, changed."""

    def found(system: System, states: State) -> Acceleration:
        torque = of(system, states)
        return with_torque(system, states, change(torque, states) - torque)

    return found


CHANGED = {
    "clipped": (gyro, lambda v, x: np.clip(v, -0.7, 0.7), "within 0.7 N m"),
    "short": (
        damping_torque,
        lambda v, x: v * np.minimum(1.0, 0.4 / np.where(norm(v) > 0.0, norm(v), 1.0))[:, None],
        "the damping torque is held below 0.4 N m",
    ),
    "turned": (gyro, lambda v, x: rotate(x.orientation, v), "the gyroscopic term is turned by R"),
    "before": (damping_torque, lambda v, x: np.roll(v, 1, axis=0), "is that of the state before"),
    "power": (
        gyro,
        lambda v, x: v * norm(x.angular_velocity)[:, None],
        "the gyroscopic term is multiplied by |omega|^1",
    ),
}


@pytest.mark.parametrize("name", CHANGED)
def test_what_is_done_to_a_term_is_named(name: str) -> None:
    of, change, phrase = CHANGED[name]
    causes = causes_over(spoiled(of, change), DAMPED)
    assert causes
    assert all(phrase in text for text in causes.values()), causes


@pytest.mark.parametrize(
    ("which", "of"),
    [
        ("the first state", lambda v: v[:1] + 0.0 * v),
        ("the last state", lambda v: v[-1:] + 0.0 * v),
        ("the state after", lambda v: np.roll(v, -1, axis=0)),
    ],
)
def test_one_buffer_for_the_momentum_of_every_state_is_named(
    which: str, of: Callable[[Array], Array]
) -> None:
    def found(system: System, states: State) -> Acceleration:
        w = states.angular_velocity
        momentum = apply(moving_inertia(system), w)
        return with_torque(system, states, cross(w, momentum) - cross(w, of(momentum)))

    due = f"I omega in the gyroscopic term is that of {which} among those that are requested"
    causes = causes_over(found, DAMPED)
    assert causes
    assert all(text.startswith(due) for text in causes.values()), causes


def heading(turn: Array) -> Array:
    """The turn about the world's z that takes x as far round as the body's x axis, (n, 3, 3)."""
    yaw = np.arctan2(turn[:, 1, 0], turn[:, 0, 0])
    c, s, o = np.cos(yaw), np.sin(yaw), 0.0 * yaw
    rows = [np.stack(row, -1) for row in ((c, -s, o), (s, c, o), (o, o, o + 1.0))]
    return np.stack(rows, -2)


ATTITUDES: dict[str, tuple[Callable[[Array], Array], str]] = {
    "heading": (heading, "is its heading alone: roll and pitch are left out"),
    "tilt": (
        lambda turn: np.swapaxes(heading(turn), -1, -2) @ turn,
        "is without its heading: roll and pitch alone",
    ),
}


@pytest.mark.parametrize("name", ATTITUDES)
def test_a_part_of_the_attitude_in_a_torque_is_named(name: str) -> None:
    """Built from matrices; with gravity on a top, all loads are not the torque in world axes."""
    change, text = ATTITUDES[name]

    def found(system: System, states: State) -> Acceleration:
        turn, world = rotation_matrix(states.orientation), np.asarray(system.load.torque_world)
        return with_torque(system, states, world @ change(turn) - world @ turn)

    top = case("top", {"gravity": GRAVITY, "pivot": PIVOT, "torque": WORLD_TORQUE})
    causes = causes_over(found, (CASES[0], CASES[6], top))
    due = f"the attitude in the torque in world axes {text}"
    assert causes == {"driven-in-world": due, "top": due}


def test_a_factor_goes_with_the_mass_where_several_masses_show_it_alone() -> None:
    def over_mass(system: System, states: State) -> Acceleration:
        less = 1.0 / float(system.body.mass) - 1.0
        return with_torque(system, states, less * gyro(system, states))

    several = causes_over(over_mass, CASES[:6])
    assert all("gyroscopic term" in text for text in several.values())
    assert all("divided by the mass" in text for text in several.values())
    (alone,) = causes_over(over_mass, CASES[:1]).values()
    assert "the gyroscopic term is scaled by 0.5" in alone
    assert "the mass" not in alone


def test_where_nothing_fits_the_dependence_on_each_size_is_measured() -> None:
    def odd(system: System, states: State) -> Acceleration:
        w = states.angular_velocity
        return with_torque(system, states, float(system.load.damping) * w * w[:, [1, 2, 0]] ** 2)

    def evidence(system: System, states: State) -> Evidence:
        return of_forward_dynamics(system, states, odd(system, states))

    system, states = CASES[2].system, random_states(CASES[2], 60, [1])
    scaled = {what: evidence(*other) for what, *other in doubled(system, states[:STATES])}
    found = dependence(evidence(system, states), scaled)
    assert "twice |omega| makes it 8 times as large" in found
    assert "twice the damping makes it 2 times as large" in found
    same = "it is the same with twice the linear velocity, the position and the mass"
    assert found.endswith(f"{same}, and it is the same at another attitude")


@pytest.mark.parametrize(
    ("weights", "phrase"),
    [((0.6, 0.4), "that is of order 1, where 2 is declared"), ((0.5, 0.5), "")],
)
def test_the_order_that_a_step_has_lost_is_named(weights: tuple[float, float], phrase: str) -> None:
    one = CASES[3]
    states = random_states(one, 6, [1])
    rate = 4.0 * float(np.max(np.abs(states.angular_velocity))) + 1.0
    steps = np.full((6, 1), DOUBLE.radians / rate) / 2.0 ** np.arange(DOUBLE.count)
    many = State(*(np.repeat(f[:, None], DOUBLE.count, axis=1) for f in vars(states).values()))
    scheme = Scheme("", "", on_quaternion(((), (1.0,)), weights), every_channel(2))
    stepped = step_body(scheme, one.system, many, steps, 1, 1)[1][-1]
    found = order_lost(one.system, Probe(states, steps), stepped, EPS, every_channel(2))
    assert phrase in found.text if found and phrase else found is None and not phrase


def test_the_attitude_that_moves_by_the_omega_of_the_start_is_named() -> None:
    one, scheme = CASES[0], SCHEMES["semi-implicit-euler"]
    states = random_states(one, 6, [1])
    rate = 4.0 * float(np.max(np.abs(states.angular_velocity))) + 1.0
    steps = np.full((6, 1), DOUBLE.radians / rate) / 2.0 ** np.arange(DOUBLE.count)
    many = State(*(np.repeat(f[:, None], DOUBLE.count, axis=1) for f in vars(states).values()))
    right = step_body(SCHEMES["lie-rk4"], one.system, many, steps, 1, 1)[1][-1]
    late = step_body(scheme, one.system, many, steps, 1, 1)[1][-1]
    stepped = replace(right, orientation=late.orientation)
    found = order_lost(one.system, Probe(states, steps), stepped, EPS, every_channel(2))
    assert found is not None
    assert "the attitude moves by omega of the step's end" in found.text
