"""Ways to misread a state, and what undoes each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.kinematics import at_point
from omegadot.reference_impl.rotations import (
    conjugate,
    normalize,
    rotate,
    rotate_inverse,
)
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Array, State, System

Change = Callable[[State], State]


@dataclass(frozen=True)
class Misreading:
    """A state reported in another convention.

    statement: the cause as text.  right: from the state as reported to the one that is meant.
    """

    statement: str
    right: Change


def _turned(field: str, turn: Callable[[Array, Array], Array]) -> Change:
    """A vector of the state, turned by its orientation."""
    return lambda state: replace(state, **{field: turn(state.orientation, getattr(state, field))})


def changed(field: str, change: Callable[[Array], Array]) -> Change:
    """One quantity of a state, changed."""
    return lambda state: replace(state, **{field: change(getattr(state, field))})


OF_ANY_STATE = (
    Misreading(
        "omega looks like world axes: it matches after R^T",
        _turned("angular_velocity", rotate_inverse),
    ),
    Misreading(
        "omega looks turned by R^T: as one set in world axes, or turned twice",
        _turned("angular_velocity", rotate),
    ),
    Misreading(
        "omega looks like degrees per second: it matches after pi/180",
        changed("angular_velocity", lambda w: w * (np.pi / 180)),
    ),
    Misreading("omega has the wrong sign", changed("angular_velocity", lambda w: -w)),
    Misreading(
        "the rotation looks transposed: it matches after the quaternion is conjugated",
        changed("orientation", conjugate),
    ),
    Misreading(
        "the quaternion looks like (x, y, z, w): it matches with the scalar first",
        changed("orientation", lambda q: np.roll(q, 1, axis=-1)),
    ),
    Misreading(
        "the linear velocity looks like body axes: it matches after R",
        _turned("linear_velocity", rotate),
    ),
)
IN_BODY_AXES = Misreading(
    "the position looks like body axes: it matches after R", _turned("position", rotate)
)
NOT_UNIT = Misreading(
    "the quaternion is not of unit length: it matches once normalised",
    changed("orientation", normalize),
)


def misreadings(system: System) -> tuple[Misreading, ...]:
    """All of them, for what comes out of an engine.

    Position or velocity may be reported at the body's origin instead of the centre of mass.
    """

    def meant(state: State) -> State:
        return at_point(state, system.body.center_of_mass)

    def position(state: State) -> State:
        return replace(state, position=meant(state).position)

    def velocity(state: State) -> State:
        return replace(state, linear_velocity=meant(state).linear_velocity)

    at = "looks like that of the body's origin, not of the centre of mass"
    both = f"position and linear velocity {at}".replace("looks", "look").replace("that", "those")
    of_origin = (
        Misreading(f"the position {at}", position),
        Misreading(f"the linear velocity {at}", velocity),
        Misreading(both, meant),
        Misreading(
            "the position is that of the body's origin and the centre of mass from it, which is "
            "not turned into the world: it is off by c - R c",
            lambda state: replace(
                state, position=meant(state).position - system.body.center_of_mass
            ),
        ),
        Misreading(
            "the position has the centre of mass's distance from the origin in it once too often",
            lambda state: replace(
                state, position=at_point(state, -system.body.center_of_mass).position
            ),
        ),
    )
    by_pivot = _from_the_origin(system) if system.load.pivot is not None else ()
    by_inertia = (
        Misreading(
            "omega is the angular momentum I omega: it matches after the inverse of the inertia",
            changed("angular_velocity", lambda w: apply(inverse(moving_inertia(system)), w)),
        ),
        Misreading(
            "omega is the angular momentum in world axes",
            lambda state: replace(
                state,
                angular_velocity=apply(
                    inverse(moving_inertia(system)),
                    rotate_inverse(state.orientation, state.angular_velocity),
                ),
            ),
        ),
    )
    return (*OF_ANY_STATE, IN_BODY_AXES, *of_origin, *by_pivot, NOT_UNIT, *by_inertia)


def _from_the_origin(system: System) -> tuple[Misreading, ...]:
    """Of a pivoted body: its place from the body's origin, or from the world's."""
    pivot = np.asarray(system.load.pivot, dtype=float)
    due = "from the body's origin, not from the pivot"

    def position(state: State) -> State:
        return replace(state, position=at_point(state, -pivot).position)

    def velocity(state: State) -> State:
        return replace(state, linear_velocity=at_point(state, -pivot).linear_velocity)

    return (
        Misreading(f"the position is R c: the centre of mass's {due}", position),
        Misreading(f"the linear velocity is omega x R c: by the lever {due}", velocity),
        Misreading(
            f"position and linear velocity are by the lever {due}",
            lambda state: at_point(state, -pivot),
        ),
        Misreading(
            "the position is off by the pivot, taken as a place in the world",
            changed("position", lambda x: x - pivot),
        ),
    )


def settings(system: System) -> tuple[Misreading, ...]:
    """How a state may be misread as it is set; `right` leads from what reads back as well."""
    about = moving_inertia(system)

    def elsewhere(state: State) -> State:
        return at_point(state, -system.body.center_of_mass)

    def position(state: State) -> State:
        return replace(state, position=elsewhere(state).position)

    def velocity(state: State) -> State:
        return replace(state, linear_velocity=elsewhere(state).linear_velocity)

    origin = "is taken as that of the body's origin when it is set"
    both = f"position and linear velocity {origin}".replace("is taken", "are taken", 1)
    return (
        Misreading(
            "the linear velocity is taken as one in body axes when it is set: R v reads back",
            _turned("linear_velocity", rotate_inverse),
        ),
        Misreading(
            "the position is taken as one in body axes when it is set: R x reads back",
            _turned("position", rotate_inverse),
        ),
        Misreading(f"the position {origin}", position),
        Misreading(f"the linear velocity {origin}", velocity),
        Misreading(both.replace("that of", "those of").replace("it is", "they are"), elsewhere),
        Misreading(
            "the quaternion is taken as (x, y, z, w) when it is set",
            changed("orientation", lambda q: np.roll(q, -1, axis=-1)),
        ),
        Misreading(
            "omega is taken in degrees per second when it is set",
            changed("angular_velocity", lambda w: w * (180 / np.pi)),
        ),
        Misreading(
            "omega is taken as the angular momentum when it is set: I^-1 omega reads back",
            changed("angular_velocity", lambda w: apply(about, w)),
        ),
        Misreading(
            "omega is taken as the angular momentum in world axes when it is set",
            lambda state: replace(
                state,
                angular_velocity=rotate(state.orientation, apply(about, state.angular_velocity)),
            ),
        ),
    )


FIELDS = {
    "orientation": "the attitude",
    "angular_velocity": "omega",
    "position": "the position",
    "linear_velocity": "the linear velocity",
}


def losses() -> dict[str, Change]:
    """What is lost of a state on its way through an engine, and cannot be undone: what is left."""

    def unsigned(q: Array) -> Array:
        return np.concatenate((np.abs(q[..., :1]), q[..., 1:]), axis=-1)

    found = {
        "the quaternion's scalar part is read back without its sign": (
            changed("orientation", unsigned)
        )
    }
    for field, what in FIELDS.items():
        single = changed(field, lambda values: values.astype(np.float32).astype(float))
        found[f"{what} is kept in single precision"] = single
        if field != "orientation":
            found[f"{what} reads back as zero"] = changed(field, lambda values: 0.0 * values)
    return found
