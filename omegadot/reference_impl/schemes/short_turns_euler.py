"""Semi-implicit Euler as DART takes it: turns below 1e-3 rad are expanded to second order."""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.rotations import exp_quaternion, quaternion_product
from omegadot.reference_impl.schemes.scheme import (
    AccelerationOf,
    Scheme,
    every_channel,
    per_component,
)
from omegadot.reference_impl.system import Array, State

SHORT = 1e-3  # rad


def _turn(rotation_vector: Array) -> Array:
    """The quaternion of ``1 + [r] + [r]^2/2`` where ``|r| < 1e-3``, else of ``exp r``.

    The former turns by ``2 atan(x / (1 - x^2))``, x = |r|/2: by ``|r|^3 / 6`` too far.
    """
    square = np.add.reduce(rotation_vector * rotation_vector, -1, keepdims=True)
    angle = np.sqrt(np.maximum(square, 1e-36))
    x = 0.5 * angle
    turned = np.where(angle < SHORT, 2 * np.arctan(x / (1 - x * x)), angle)
    return exp_quaternion(rotation_vector * (turned / angle))


def step(acceleration: AccelerationOf, state: State, dt: float | Array) -> State:
    """As semi-implicit Euler, the attitude by the turn above."""
    h = per_component(dt)
    found = acceleration(state)
    w = state.angular_velocity + h * found.angular
    v = state.linear_velocity + h * found.linear
    q = quaternion_product(state.orientation, _turn(w * h))
    return State(q, w, state.position + h * v, v)


SCHEME = Scheme(
    name="semi-implicit-euler-short-turns",
    title="Semi-implicit Euler, turns below 1e-3 rad expanded to second order",
    step=step,
    orders=every_channel(1),
    special={"free": {"linear_momentum": None}},
    source="DART (dart/math/Geometry.cpp, expMapRot), confirmed by its steps",
)
