"""Ways to misread a state, each with what undoes it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from omegadot.reference_impl.kinematics import at_point
from omegadot.reference_impl.rotations import conjugate, normalize, rotate, rotate_inverse
from omegadot.reference_impl.system import State, System

Change = Callable[[State], State]


@dataclass(frozen=True)
class Misreading:
    """A state reported in another convention.

    statement: the cause as text.  right: from the state as reported to the one that is meant.
    wrong: the inverse, from the state that is meant to the one reported.
    """

    statement: str
    right: Change
    wrong: Change


def _omega(turn: Callable[..., np.ndarray]) -> Change:
    def change(state: State) -> State:
        return replace(state, angular_velocity=turn(state.orientation, state.angular_velocity))

    return change


def _velocity(turn: Callable[..., np.ndarray]) -> Change:
    def change(state: State) -> State:
        return replace(state, linear_velocity=turn(state.orientation, state.linear_velocity))

    return change


def _quaternion(change: Callable[[np.ndarray], np.ndarray]) -> Change:
    return lambda state: replace(state, orientation=change(state.orientation))


def _scaled_omega(factor: float) -> Change:
    return lambda state: replace(state, angular_velocity=factor * state.angular_velocity)


OF_ANY_STATE = (
    Misreading(
        "omega looks like world axes: it matches after R^T",
        _omega(rotate_inverse),
        _omega(rotate),
    ),
    Misreading(
        "omega looks turned twice: it matches after R",
        _omega(rotate),
        _omega(rotate_inverse),
    ),
    Misreading(
        "omega looks like degrees per second: it matches after pi/180",
        _scaled_omega(np.pi / 180),
        _scaled_omega(180 / np.pi),
    ),
    Misreading("omega has the wrong sign", _scaled_omega(-1.0), _scaled_omega(-1.0)),
    Misreading(
        "the rotation looks transposed: it matches after the quaternion is conjugated",
        _quaternion(conjugate),
        _quaternion(conjugate),
    ),
    Misreading(
        "the quaternion looks like (x, y, z, w): it matches with the scalar first",
        _quaternion(lambda q: np.roll(q, 1, axis=-1)),
        _quaternion(lambda q: np.roll(q, -1, axis=-1)),
    ),
    Misreading(
        "the linear velocity looks like body axes: it matches after R",
        _velocity(rotate),
        _velocity(rotate_inverse),
    ),
)
NOT_UNIT = Misreading(
    "the quaternion is not of unit length: it matches once normalised",
    _quaternion(normalize),
    _quaternion(normalize),
)


def of_origin(system: System) -> tuple[Misreading, ...]:
    """Position or velocity reported at the body's origin instead of the centre of mass."""

    def meant(state: State) -> State:
        return at_point(state, system.body.center_of_mass)

    def position(state: State) -> State:
        return replace(state, position=meant(state).position)

    def velocity(state: State) -> State:
        return replace(state, linear_velocity=meant(state).linear_velocity)

    at = "looks like that of the body's origin, not of the centre of mass"
    nothing: Change = lambda state: state  # noqa: E731
    return (
        Misreading(f"the position {at}", position, nothing),
        Misreading(f"the linear velocity {at}", velocity, nothing),
        Misreading(
            f"position and linear velocity {at}".replace("looks", "look").replace("that", "those"),
            meant,
            nothing,
        ),
    )


def misreadings(system: System) -> tuple[Misreading, ...]:
    """All of them, for what comes out of an engine."""
    return (*OF_ANY_STATE, *of_origin(system), NOT_UNIT)
