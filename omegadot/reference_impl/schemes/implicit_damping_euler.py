"""Semi-implicit Euler with implicit damping: the gyroscopic term at the step's start."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.reference_impl.rotations import turn_in_body
from omegadot.reference_impl.schemes.jacobian import (
    acceleration_and_jacobian,
    solve_one_minus,
)
from omegadot.reference_impl.schemes.scheme import (
    AccelerationOf,
    Scheme,
    every_channel,
    per_component,
)
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Array, State


def step(acceleration: AccelerationOf, state: State, dt: float | Array) -> State:
    """``(1 - h J₀) Δω = h ω̇`` with ``J₀ = ∂ω̇/∂ω`` at ω = 0, then as semi-implicit Euler.

    By equation (8) with a viscous torque ``J₀ = -d I⁻¹``, so that ``(I + h d) Δω = h I ω̇``: at
    ω = 0 the gyroscopic term, being quadratic, has no derivative. Without damping this is
    semi-implicit Euler.
    """
    h = per_component(dt)
    found = acceleration(state)
    at_rest = replace(state, angular_velocity=np.zeros_like(state.angular_velocity))
    size = _natural_rate(state.angular_velocity, found.angular)
    _, angular, linear = acceleration_and_jacobian(acceleration, at_rest, size)
    turn = h if isinstance(h, float) else h[..., None]
    change = solve_one_minus(turn * angular, h * found.angular)
    w = state.angular_velocity + change
    v = state.linear_velocity + h * (found.linear + apply(linear, change))
    return State(turn_in_body(state.orientation, w, h), w, state.position + h * v, v)


def _natural_rate(w: Array, omega_dot: Array) -> Array:
    """(..., 1) rad/s: ``(|ω|² + |ω̇|)^½``, at which what depends on ω is as large as what does not.

    Unlike any constant it scales with the unit of time.
    """
    spin, pull = np.add.reduce(w * w, -1), np.add.reduce(omega_dot * omega_dot, -1)
    rate: Array = np.sqrt(spin + np.sqrt(pull))[..., None]
    return rate


SCHEME = Scheme(
    name="implicit-damping-euler",
    title="Semi-implicit Euler with implicit damping, exponential in attitude",
    step=step,
    orders=every_channel(1),
    special={"free": {"linear_momentum": None}},
    source="MuJoCo documentation, Computation, Numerical integration",
)
