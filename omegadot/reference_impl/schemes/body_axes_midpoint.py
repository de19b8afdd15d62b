"""Midpoint in both momenta, in body axes: MuJoCo 3.7 to 3.10 with the centre of mass off."""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import rotate, rotate_inverse, turn_in_body
from omegadot.reference_impl.schemes.frozen_torque_midpoint import mean_velocity
from omegadot.reference_impl.schemes.scheme import (
    AccelerationOf,
    Scheme,
    every_channel,
    per_component,
)
from omegadot.reference_impl.system import Array, State


def step(acceleration: AccelerationOf, state: State, dt: float | Array) -> State:
    """ω and q as frozen-torque-midpoint; ``u₁ - u₀ = h (q₀⁻¹ a* - ω_m × (u₀ + u₁)/2)``.

    ``u = q⁻¹ v`` is the velocity in body axes, ``v₁ = q₁ u₁`` and ``p₁ = p₀ + h (v₀ + v₁)/2``. The
    forces stay in body axes for the step, so that gravity is turned by half the step's turn, and
    as u is turned by Cayley's increment but q by the exponential, a steady velocity too is turned:
    by ``|h ω|³/12`` a step.
    """
    h = per_component(dt)
    mean, found = mean_velocity(acceleration, state, h)
    q = turn_in_body(state.orientation, mean, h)
    u = rotate_inverse(state.orientation, state.linear_velocity)
    push = h * rotate_inverse(state.orientation, found.linear)
    v = rotate(q, _unturned(u - cross(0.5 * h * mean, u) + push, 0.5 * h * mean))
    return State(
        q,
        2 * mean - state.angular_velocity,
        state.position + 0.5 * h * (state.linear_velocity + v),
        v,
    )


def _unturned(b: Array, r: Array) -> Array:
    """The x with ``x + r × x = b``: ``(b - r × b + r (r·b)) / (1 + |r|²)``, (..., 3)."""
    along = np.add.reduce(r * b, -1, keepdims=True)
    x: Array = (b - cross(r, b) + r * along) / (1 + np.add.reduce(r * r, -1, keepdims=True))
    return x


SCHEME = Scheme(
    name="body-axes-midpoint",
    title="Midpoint of both momenta in body axes, loads of the step's start",
    step=step,
    orders=every_channel(1),
    special={"torque-free": {"omega": 2, "attitude": 2, "angular_momentum": 2}},
    source="MuJoCo's changelog, versions 3.7.0 and 3.11.0, the linear velocity by its steps",
    solved_to=3e-13,
)
