"""Inertias about the pivot that are made in another way are found with how they are made."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from wrong_equations import CASES, GRAVITY, PIVOT, WORLD_TORQUE, case

from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.evidence import FORWARD, of_forward_dynamics
from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.equations.pivot_inertia import pivot_inertia
from omegadot.diagnosis.wording.features import features_of
from omegadot.gates.states.equation import random_states
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.loads import torque
from omegadot.reference_impl.motion import center_of_mass_acceleration
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array, State, System

Tensors = Callable[[Array, float, Array], tuple[Array, Array]]
EVERY = (
    *CASES,
    case(
        "top-heavy", {"gravity": [0.4, 3.1, -2.0], "pivot": [0.7, 0.35, -0.3], "damping": 1.3}, 5.3
    ),
    case("top-light", {"gravity": GRAVITY, "pivot": [0.1, -0.5, 0.3], "damping": 0.08}, 0.4),
    case("top-more", {"pivot": [0.2, -0.6, 0.47], "torque": WORLD_TORQUE, "damping": 2.2}),
)


def _shift(r: Array) -> Array:
    return float(r @ r) * np.eye(3) - np.outer(r, r)


def without_the_mass(own: Array, m: float, r: Array) -> tuple[Array, Array]:
    return own + _shift(r), own + _shift(r)


def one_square_twice(own: Array, m: float, r: Array) -> tuple[Array, Array]:
    made = own + m * _shift(r)
    made[0, 0] = own[0, 0] + 2.0 * m * r[1] ** 2
    return made, made


def one_product_in_the_solve(own: Array, m: float, r: Array) -> tuple[Array, Array]:
    made = own + m * _shift(r)
    made[1, 2] = made[2, 1] = own[1, 2] + m * r[1] * r[2]
    return made, own + m * _shift(r)


def nearly(own: Array, m: float, r: Array) -> tuple[Array, Array]:
    """No power of the mass."""
    made = own + m / (1.0 + 1e-3 * m) * _shift(r)
    return made, made


def _accelerations(system: System, x: State, tensors: Tensors) -> Acceleration:
    w, own = x.angular_velocity, np.asarray(system.body.inertia, dtype=float)
    solved = spun = np.asarray(moving_inertia(system), dtype=float)
    if system.load.pivot is not None:
        arm = np.asarray(lever(system), dtype=float)
        solved, spun = tensors(own, float(system.body.mass), arm)
    due = torque(system, x) - cross(w, apply(spun, w))
    angular = np.linalg.solve(np.broadcast_to(solved, (len(w), 3, 3)), due[..., None])[..., 0]
    return Acceleration(angular, center_of_mass_acceleration(system, x, angular))


def _scenes(tensors: Tensors, cases: Any) -> list[Scene]:
    scenes = []
    for one in cases:
        x = random_states(one, 40, [1])
        evidence = of_forward_dynamics(one.system, x, _accelerations(one.system, x, tensors))
        features = features_of(one.system, one.initial)
        scenes.append(Scene(one.name, one.system, features, {FORWARD: evidence}))
    return scenes


FOUND = {
    one_square_twice: "pivot, I_xx + m 2 y^2 stands in place of I_xx + m (y^2 + z^2), with I",
    one_product_in_the_solve: "I_yz + m y z stands in place of I_yz - m y z, where omega-dot is",
}


@pytest.mark.parametrize("tensors", FOUND)
def test_how_the_inertia_about_the_pivot_is_made_is_found(tensors: Tensors) -> None:
    """Caught: six numbers of each scenario, where one rule makes them all."""
    across = Across()
    for scene in _scenes(tensors, EVERY):
        across.add(scene)
    assert FOUND[tensors] in across.cause("top-heavy", FORWARD)


def test_what_no_power_of_the_mass_makes_is_not_named() -> None:
    assert not pivot_inertia([one.evidence[FORWARD] for one in _scenes(nearly, EVERY)])


def test_free_bodies_that_are_wrong_as_well_are_of_another_cause() -> None:
    scenes = [one.evidence[FORWARD] for one in _scenes(one_square_twice, EVERY)]
    free = next(one for one in scenes if one.system.load.pivot is None)
    free.found.angular[:] *= 1.001
    assert not pivot_inertia(scenes)


def test_another_inertia_rounds_as_its_own_condition_lets_it() -> None:
    """Caught: a cause that is lost on one light body, of which it makes a large one."""
    thin = (1e-6 * np.array(CASES[0].system.body.inertia)).tolist()
    light = case("top-thin", {"gravity": GRAVITY, "pivot": PIVOT}, 6e-4, thin)
    across = Across()
    for scene in _scenes(without_the_mass, (*EVERY, light)):
        across.add(scene)
    right = "the parallel-axis theorem is taken with a mass of 1 kg"
    assert {across.cause(name, FORWARD) for name in ("top-driven", "top-thin")} == {right}
