"""One torque that is solved for by another matrix than the rest."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from test_causes import causes_over
from wrong_equations import CASES, gyroscopic, with_torque

from omegadot.gates.case import Case
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import damping_torque, gravity_torque
from omegadot.reference_impl.rotations import rotate_inverse
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array, State, System

FREE, DAMPED, DRIVEN, TOPS = CASES[:2], CASES[2:5], CASES[5:7], (CASES[7], *CASES[10:])
Of = Callable[[System, State], Array]


def gyro(system: System, states: State) -> Array:
    return -gyroscopic(system, states)


def in_world(system: System, states: State) -> Array:
    return rotate_inverse(states.orientation, system.load.torque_world)


def all_loads(system: System, states: State) -> Array:
    body = system.load.torque_body + 0.0 * states.angular_velocity
    damping, weight = damping_torque(system, states), gravity_torque(system, states)
    return np.asarray(body + in_world(system, states) + damping + weight)


def solved(of: Of, matrix: Callable[[System], Array]) -> Callable[..., Acceleration]:
    """The right equation, of which one torque makes omega-dot by its own matrix."""

    def found(system: System, states: State) -> Acceleration:
        torque = of(system, states)
        own = apply(moving_inertia(system) @ matrix(system), torque)
        return with_torque(system, states, own - torque)

    return found


def over_diagonal(system: System) -> Array:
    return np.diag(1.0 / np.diag(moving_inertia(system)))


def over_center(system: System) -> Array:
    return np.linalg.inv(np.asarray(system.body.inertia, dtype=float))


CASES_OF: dict[str, tuple[Of, Callable[[System], Array], tuple[Case, ...], str]] = {
    "gyro": (
        gyro,
        over_diagonal,
        (*FREE, *DAMPED, *TOPS),
        "the gyroscopic term is divided by the inertia's diagonal alone",
    ),
    "weight": (
        gravity_torque,
        over_center,
        TOPS,
        "the torque of gravity is divided by the inertia about the centre of mass",
    ),
    "world": (
        in_world,
        lambda s: np.eye(3) * 3.0 / np.trace(moving_inertia(s)),
        (*DRIVEN, *TOPS),
        "the torque in world axes is divided by the mean of the moments of inertia",
    ),
    "damping": (
        damping_torque,
        lambda s: np.asarray(moving_inertia(s)),
        (*DAMPED, *TOPS),
        "the damping torque is multiplied by the inertia, not by its inverse",
    ),
    "gyro-mass": (
        gyro,
        lambda s: np.eye(3) / float(s.body.mass),
        (*DAMPED, *TOPS),
        "the gyroscopic term is divided by the mass in place of the inertia",
    ),
    "loads": (
        all_loads,
        over_diagonal,
        (*DAMPED, *DRIVEN, *TOPS),
        "the torque of all loads is divided by the inertia's diagonal alone",
    ),
}


@pytest.mark.parametrize("name", CASES_OF)
def test_a_torque_with_a_matrix_of_its_own_is_named(name: str) -> None:
    of, matrix, cases, text = CASES_OF[name]
    causes = causes_over(solved(of, matrix), cases)
    assert causes
    assert set(causes.values()) == {text}, causes


def test_a_matrix_that_is_no_known_one_is_not_taken_for_one() -> None:
    """Two percent off the diagonal: what is near a known matrix is not it."""
    causes = causes_over(solved(gyro, lambda s: 1.02 * over_diagonal(s)), (*DAMPED, *TOPS))
    assert not any("divided by" in text for text in causes.values()), causes


def test_the_whole_equation_by_the_diagonal_is_not_said_of_one_torque() -> None:
    def whole(system: System, states: State) -> Array:
        return gyro(system, states) + all_loads(system, states)

    causes = causes_over(solved(whole, over_diagonal), (*FREE, *DAMPED, *TOPS))
    due = "where omega-dot is solved for, only the diagonal of the whole inertia is used"
    assert causes
    assert all(due in text for text in causes.values()), causes
