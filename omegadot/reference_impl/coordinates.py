"""The coordinates in which one body's motion is stepped, and states in them.

A scheme errs otherwise in other coordinates: an engine that keeps the origin's position and
velocity steps those, and with the centre of mass off the origin its scheme errs in the momentum of
translation, though the scheme is the same.
"""

from __future__ import annotations

from typing import Literal, get_args

import numpy as np

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.kinematics import at_point, place_on_pivot
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.system import Acceleration, Array, State, System

Coordinates = Literal["com-world", "origin-world", "body-spatial"]
"""What of a free body's translation is stepped.

``com-world``: position and velocity of the centre of mass in the world.  ``origin-world``: those of
the body's origin.  ``body-spatial``: the origin's position, and its velocity in body axes, so that
v is the spatial velocity of Featherstone, Rigid Body Dynamics Algorithms (2008), 2.2, and the
exponential is that of SE(3).

q is (position, quaternion), (..., 7), and v is (linear, angular), (..., 6), ω in body axes. A
pivoted body has the same in all of them: q is the quaternion, (..., 4), and v is ω, (..., 3).
"""

COORDINATES: tuple[Coordinates, ...] = get_args(Coordinates)
PHRASES: dict[str, str] = {
    "com-world": "the centre of mass",
    "origin-world": "the body's origin",
    "body-spatial": "the spatial velocity in body axes",
}


def canonical(system: System, coordinates: Coordinates) -> Coordinates:
    """The first coordinates in which the system's steps are the same."""
    body, load = system.body, system.load
    same = coordinates == "origin-world" and not np.any(body.center_of_mass)
    return "com-world" if load.pivot is not None or same else coordinates


def distinct(system: System) -> tuple[Coordinates, ...]:
    """The coordinates in which the system's steps differ."""
    return tuple(dict.fromkeys(canonical(system, one) for one in COORDINATES))


def to_coordinates(system: System, state: State, coordinates: Coordinates) -> tuple[Array, Array]:
    """Q and v of a state; the origin's position and velocity are ``x - R c``, ``v - R (ω × c)``."""
    attitude, w = state.orientation, state.angular_velocity
    if system.load.pivot is not None:
        return attitude, w
    if coordinates != "com-world":
        state = at_point(state, -system.body.center_of_mass)
    velocity = state.linear_velocity
    if coordinates == "body-spatial":
        velocity = rotate_inverse(attitude, velocity)
    return _joined(state.position, attitude), _joined(velocity, w)


def from_coordinates(system: System, q: Array, v: Array, coordinates: Coordinates) -> State:
    """The inverse of `to_coordinates`; a pivoted body is placed where its pivot holds it."""
    attitude, w = q[..., -4:], v[..., -3:]
    if system.load.pivot is not None:
        nowhere = np.zeros_like(w)
        return place_on_pivot(system, State(attitude, w, nowhere, nowhere))
    place, velocity = q[..., :3], v[..., :3]
    if coordinates == "body-spatial":
        velocity = rotate(attitude, velocity)
    state = State(attitude, w, place, velocity)
    return state if coordinates == "com-world" else at_point(state, system.body.center_of_mass)


def acceleration_in(
    system: System, state: State, found: Acceleration, coordinates: Coordinates
) -> Array:
    """``v̇`` (..., n) of a state with these accelerations.

    The origin's is ``a - R (ω̇ × c + ω × (ω × c))``; that of its velocity u in body axes is the
    same, turned into them, less ``ω × u``.
    """
    if system.load.pivot is not None:
        return found.angular
    w, linear = state.angular_velocity, found.linear
    if coordinates != "com-world":
        c = system.body.center_of_mass
        lever = cross(found.angular, c) + cross(w, cross(w, c))
        linear = linear - rotate(state.orientation, lever)
    if coordinates == "body-spatial":
        u = to_coordinates(system, state, coordinates)[1][..., :3]
        linear = rotate_inverse(state.orientation, linear) - cross(w, u)
    return _joined(linear, found.angular)


def _joined(first: Array, last: Array) -> Array:
    lead = np.broadcast_shapes(first.shape[:-1], last.shape[:-1])
    parts = [np.broadcast_to(part, (*lead, part.shape[-1])) for part in (first, last)]
    return np.concatenate(parts, axis=-1)
