"""A solve by a matrix that is no inverse of the inertia is found with where it differs."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from wrong_equations import BODY_TORQUE, GRAVITY, PIVOT, WORLD_TORQUE, case

from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.evidence import FORWARD, of_forward_dynamics
from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.equations.solve_matrix import solve_matrix
from omegadot.diagnosis.wording.features import features_of
from omegadot.gates.states.equation import random_states
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import torque
from omegadot.reference_impl.motion import center_of_mass_acceleration
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array, State, System

Solve = Callable[[Array], Array]
FULL = [[1.3, 0.3, 0.2], [0.3, 1.6, -0.25], [0.2, -0.25, 2.1]]
OTHER = [[3.0, -0.7, 0.4], [-0.7, 2.6, 0.9], [0.4, 0.9, 4.1]]
PLAIN = [[1.2, 0.0, 0.0], [0.0, 1.7, 0.0], [0.0, 0.0, 2.3]]
EVERY = (
    case("full", {"torque": BODY_TORQUE}, tensor=FULL),
    case("other", {"torque": WORLD_TORQUE, "damping": 0.3}, tensor=OTHER),
    case("top", {"gravity": GRAVITY, "pivot": PIVOT}, tensor=OTHER),
    case("free", {}, tensor=FULL),
    case("plain", {"torque": BODY_TORQUE}, tensor=PLAIN),
    case("plain-damped", {"damping": 0.7}, tensor=PLAIN),
)


def wrong_factor(inertia: Array) -> Array:
    """L D L^T with ``l32 = (I32 - l31 l21) / d2``, which lacks a d1."""
    d1 = inertia[0, 0]
    l21, l31 = inertia[1, 0] / d1, inertia[2, 0] / d1
    d2 = inertia[1, 1] - l21 * l21 * d1
    l32 = (inertia[2, 1] - l31 * l21) / d2
    d3 = inertia[2, 2] - l31 * l31 * d1 - l32 * l32 * d2
    lower = np.array([[1.0, 0.0, 0.0], [l21, 1.0, 0.0], [l31, l32, 1.0]])
    return np.asarray(np.linalg.inv(lower @ np.diag([d1, d2, d3]) @ lower.T))


def eliminated_once(inertia: Array) -> Array:
    """Gauss's elimination that leaves the last row's second entry as it was."""
    made = inertia.copy()
    made[2, 1] += inertia[2, 0] * inertia[0, 1] / inertia[0, 0]
    return np.asarray(np.linalg.inv(made))


def wrong_cofactor(inertia: Array) -> Array:
    made = np.linalg.inv(inertia)
    made[0, 2] = (inertia[0, 1] * inertia[1, 2] + inertia[0, 2] * inertia[1, 1]) / np.linalg.det(
        inertia
    )
    return np.asarray(made)


def series(inertia: Array) -> Array:
    """Three terms of ``D^-1 - D^-1 P D^-1 + ...``, D the diagonal and P the products."""
    d = np.diag(1.0 / np.diag(inertia))
    p = d @ (inertia - np.diag(np.diag(inertia)))
    return np.asarray((np.eye(3) - p + p @ p) @ d)


FOUND: dict[Solve, str] = {
    eliminated_once: "it is not symmetric, and differs in zy alone, but only where the inertia has",
    wrong_cofactor: "it is not symmetric, and its inverse differs from the inertia's in xz alone",
}


def _scenes(accelerations: Callable[[System, State], Acceleration]) -> list[Scene]:
    scenes = []
    for one in EVERY:
        x = random_states(one, 20, [1])
        evidence = of_forward_dynamics(one.system, x, accelerations(one.system, x))
        features = features_of(one.system, one.initial)
        scenes.append(Scene(one.name, one.system, features, {FORWARD: evidence}))
    return scenes


def _by(solve: Solve) -> Callable[[System, State], Acceleration]:
    def found(system: System, x: State) -> Acceleration:
        inertia, w = np.asarray(moving_inertia(system), dtype=float), x.angular_velocity
        angular = apply(solve(inertia), torque(system, x) - cross(w, apply(inertia, w)))
        return Acceleration(angular, center_of_mass_acceleration(system, x, angular))

    return found


@pytest.mark.parametrize("solve", FOUND)
def test_a_matrix_of_nine_numbers_is_found(solve: Solve) -> None:
    """Caught: nothing but that omega-dot is off."""
    across = Across()
    for scene in _scenes(_by(solve)):
        across.add(scene)
    assert FOUND[solve] in across.cause("full", FORWARD)


@pytest.mark.parametrize(
    ("solve", "phrase"),
    [
        (wrong_factor, "it is symmetric, and differs in yz alone, but only where the inertia has"),
        (series, "not the inertia: it is symmetric, but only where the inertia has products"),
    ],
)
def test_of_a_symmetric_matrix_it_is_said_where_it_differs(solve: Solve, phrase: str) -> None:
    assert phrase in solve_matrix([one.evidence[FORWARD] for one in _scenes(_by(solve))])


def test_what_depends_on_omega_in_another_way_is_no_such_matrix() -> None:
    """A thousandth of the solve goes as |omega|, and a factor of omega-dot is no matrix."""

    def nearly(system: System, x: State) -> Acceleration:
        made = _by(wrong_factor)(system, x)
        size = np.linalg.norm(x.angular_velocity, axis=-1, keepdims=True)
        return Acceleration(made.angular * (1.0 + 1e-3 * np.tanh(size)), made.linear)

    def scaled(inertia: Array) -> Array:
        return np.asarray(np.linalg.inv(1.3 * inertia))

    for wrong in (nearly, _by(scaled)):
        assert not solve_matrix([one.evidence[FORWARD] for one in _scenes(wrong)])
