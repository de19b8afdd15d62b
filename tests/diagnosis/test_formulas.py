"""Wrong equations that no list has: found as one product of known vectors, or not named."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from wrong_equations import CASES, GRAVITY, PIVOT, WORLD_TORQUE, case, with_torque

from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.by_formula import ByFormula, by_formula
from omegadot.diagnosis.equations.evidence import (
    FORWARD,
    INVERSE,
    of_forward_dynamics,
    of_inverse_dynamics,
)
from omegadot.diagnosis.equations.held import Scene, Scenes
from omegadot.diagnosis.equations.known import known_over
from omegadot.diagnosis.wording.features import features_of
from omegadot.gates.bounds.scales import norm
from omegadot.gates.case import Case
from omegadot.gates.states.equation import random_acceleration, random_states
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.motion import (
    center_of_mass_acceleration,
    forward_dynamics,
    inverse_dynamics,
)
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array, State, System

Torque = Callable[[System, State], Array]
MORE = (
    case("top-heavy", {"gravity": [0.4, 3.1, -2.0], "pivot": PIVOT, "damping": 1.3}, 5.3),
    case("top-light", {"gravity": GRAVITY, "pivot": [0.1, -0.5, 0.3], "damping": 0.08}, 0.4),
    case("top-driven-more", {"pivot": [0.2, 0.2, 0.5], "torque": WORLD_TORQUE, "damping": 2.2}),
)
EVERY = (*CASES, *MORE)


def _arm(system: System, w: Array) -> Array:
    return 0.0 * w + (lever(system) if system.load.pivot is not None else 0.0)


def _down(system: System, x: State) -> Array:
    return rotate_inverse(x.orientation, system.load.gravity + 0.0 * x.position)


def _size(v: Array) -> Array:
    return norm(v)[:, None]


def _unit(v: Array) -> Array:
    return v / np.where(_size(v) > 0.0, _size(v), 1.0)


def on_lever(s: System, x: State) -> Array:
    w = x.angular_velocity
    return -0.3 * s.load.damping * cross(_arm(s, w), cross(w, _arm(s, w)))


def gradient(s: System, x: State) -> Array:
    u = _unit(_down(s, x))
    return 1e-6 * _size(_down(s, x)) * cross(u, apply(s.body.inertia, u))


def friction(s: System, x: State) -> Array:
    w = x.angular_velocity
    weight = float(s.body.mass) * _size(_down(s, x)) * _size(_arm(s, w))
    return -1e-3 * weight * _unit(w)


def each_axis(s: System, x: State) -> Array:
    w = x.angular_velocity
    return -0.02 * s.load.damping * np.abs(w) * w


def of_momentum(s: System, x: State) -> Array:
    w = x.angular_velocity
    return 0.1 * cross(w, apply(s.body.inertia, apply(s.body.inertia, w)))


def world_torque_turned_twice(s: System, x: State) -> Array:
    once = rotate_inverse(x.orientation, s.load.torque_world + 0.0 * x.position)
    return rotate_inverse(x.orientation, once) - once


def damping_over_the_mass(s: System, x: State) -> Array:
    """The rate of the damping is -(d / m) omega, whatever the inertia."""
    w, d = x.angular_velocity, float(s.load.damping)
    return d * w - apply(moving_inertia(s), d / float(s.body.mass) * w)


def weight_at_the_place(s: System, x: State) -> Array:
    """A torque of gravity without the mass, at the centre of mass from the origin."""
    arm, down = _arm(s, x.angular_velocity), _down(s, x)
    if s.load.pivot is None:
        return 0.0 * arm
    center = np.asarray(s.body.center_of_mass)
    return cross(center + 0.0 * arm, down) - float(s.body.mass) * cross(arm, down)


TORQUES: dict[str, tuple[Torque, str]] = {
    "lever": (on_lever, "a torque k d r x v is added, with k = -0.3 1/m^2, r the lever"),
    "gradient": (gradient, "a torque k (g x I_c g) / |g| is added, with k = 1e-6 1/m"),
    "friction": (friction, "a torque -0.001 m|g||r| omega / |omega| is added"),
    "each": (each_axis, "a torque k d |omega_i| omega_i is added, with k = -0.02 s"),
    "momentum": (of_momentum, "omega x I_c I_c omega is added, with k = 0.1 1/(kg m^2)"),
    "damping": (damping_over_the_mass, "the damping is -d omega / m, where -I^-1 d omega is right"),
    "weight": (weight_at_the_place, "in place of the torque of gravity stands -g x c"),
    "twice": (world_torque_turned_twice, "in place of the torque in world axes stands R^T tau_w"),
}


def scenes_of(found: Callable[[System, State], Acceleration], cases: tuple[Case, ...]) -> Scenes:
    scenes = Scenes()
    for one in cases:
        states = random_states(one, 40, [1])
        evidence = of_forward_dynamics(one.system, states, found(one.system, states))
        features = features_of(one.system, one.initial)
        scenes.by_name[one.name] = Scene(one.name, one.system, features, {FORWARD: evidence})
    return scenes


def by_torque(torque: Torque) -> ByFormula:
    return by_formula(scenes_of(lambda s, x: with_torque(s, x, torque(s, x)), EVERY), FORWARD)


def text_of(found: ByFormula) -> str:
    assert len(found.whole) == 1
    one = found.whole[0].candidate
    assert one.numbers is not None
    return one.text(CASES[0].system)


@pytest.mark.parametrize("name", TORQUES)
def test_a_product_of_known_vectors_is_found_with_its_law(name: str) -> None:
    torque, phrase = TORQUES[name]
    assert phrase in text_of(by_torque(torque))


@pytest.mark.parametrize("name", TORQUES)
def test_what_is_nearly_such_a_product_is_not_named(name: str) -> None:
    """A thousandth of another vector is in it."""

    def nearly(s: System, x: State) -> Array:
        right = TORQUES[name][0](s, x)
        return right + 1e-3 * _size(right) * np.array([1.0, -2.0, 0.5])

    found = by_torque(nearly)
    assert not found.whole
    assert not found.partly
    assert not found.own
    assert not found.along


def test_a_force_is_found_with_the_mass_that_it_is_divided_by() -> None:
    def magnus(s: System, x: State) -> Acceleration:
        true = forward_dynamics(s, x)
        v = rotate_inverse(x.orientation, x.linear_velocity)
        push = 0.02 * rotate(x.orientation, cross(x.angular_velocity, v)) / float(s.body.mass)
        return replace(true, linear=true.linear + (push if s.load.pivot is None else 0.0 * push))

    found = text_of(by_formula(scenes_of(magnus, EVERY), FORWARD))
    assert "has k (omega x v) / m in it, with k = 0.02 kg" in found


def test_a_product_in_place_of_a_term_of_the_linear_acceleration_is_found() -> None:
    """Caught: two terms of which one is too much, where one stands in place of the other."""

    def wrong_order(s: System, x: State) -> Acceleration:
        true, w = forward_dynamics(s, x), x.angular_velocity
        if s.load.pivot is None:
            return true
        arm = lever(s) + 0.0 * w
        off = cross(true.angular, cross(true.angular, arm)) - cross(w, cross(w, arm))
        return Acceleration(true.angular, true.linear + rotate(x.orientation, off))

    found = text_of(by_formula(scenes_of(wrong_order, EVERY), FORWARD))
    assert "has -omega-dot x (r x omega-dot) in place of omega x (omega x r), with r" in found


def test_products_of_the_parallel_axis_theorem_are_found_in_the_inertia() -> None:
    def wrong_sign(s: System, x: State) -> Acceleration:
        own, whole = np.asarray(s.body.inertia), np.asarray(moving_inertia(s))
        more = whole - own
        tensor = own + 2.0 * np.diag(np.diag(more)) - more
        true, w = forward_dynamics(s, x), x.angular_velocity
        torque = apply(whole, true.angular) + cross(w, apply(whole, w))
        due = (torque - cross(w, apply(tensor, w)))[..., None]
        angular = np.linalg.solve(np.broadcast_to(tensor, (len(w), 3, 3)), due)[..., 0]
        if s.load.pivot is None:
            return true
        return Acceleration(angular, center_of_mass_acceleration(s, x, angular))

    found = text_of(by_formula(scenes_of(wrong_sign, EVERY), FORWARD))
    assert found.startswith("2 m products(r r^T) is added to the inertia, with r the lever")


def test_a_factor_of_its_own_on_each_system_is_stated_as_one() -> None:
    def odd(s: System, x: State) -> Array:
        w = x.angular_velocity
        return np.sin(9.0 * float(s.body.mass)) * cross(_unit(w), apply(s.body.inertia, w))

    found = by_torque(odd)
    assert not found.whole
    assert [len(one.numbers) > 3 for one in found.own] == [True]


def test_where_nothing_fits_one_sentence_holds_on_every_scenario() -> None:
    """A fact that one scenario contradicts is left out."""

    def odd(s: System, x: State) -> Array:
        w = x.angular_velocity
        return -np.tanh(_size(w)) * w * (1.0 + (float(s.body.mass) > 2.5) * _size(w) ** 0.3)

    scenes = scenes_of(lambda s, x: with_torque(s, x, odd(s, x)), EVERY)
    failing = list(scenes.by_name.values())
    assert known_over(failing, [], FORWARD, "") == ("omega-dot is off, by a torque along omega")
    across = Across()
    for scene in failing[:2]:
        across.add(scene)
    assert len({across.known(scene.name, FORWARD) for scene in failing[:2]}) == 1


def test_a_torque_that_inverse_dynamics_add_is_found() -> None:
    across = Across()
    for one in EVERY:
        system, x = one.system, random_states(one, 40, [1])
        requested = random_acceleration(system, x, [2])
        more = 0.2 * cross(requested.angular, apply(system.body.inertia, x.angular_velocity))
        torque = inverse_dynamics(system, x, requested) + more
        evidence = of_inverse_dynamics(system, x, requested, torque)
        features = features_of(system, one.initial)
        across.add(Scene(one.name, system, features, {INVERSE: evidence}))
    (text,) = {across.formula_of_torque(one.name) for one in EVERY}
    assert text.startswith("inverse dynamics are wrong: a torque k omega-dot x I_c omega is added")
