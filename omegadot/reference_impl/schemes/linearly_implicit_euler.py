"""Linearly implicit Euler: one Newton step of the implicit Euler rule in the velocities."""

from __future__ import annotations

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
    """``(1 - h J) Δω = h ω̇`` with ``J = ∂ω̇/∂ω`` at fixed attitude, then as semi-implicit Euler.

    The linear acceleration follows the change of ω too: ``Δv = h (a + (∂a/∂ω) Δω)``.
    """
    h = per_component(dt)
    found, angular, linear = acceleration_and_jacobian(acceleration, state)
    turn = h if isinstance(h, float) else h[..., None]
    change = solve_one_minus(turn * angular, h * found.angular)
    w = state.angular_velocity + change
    v = state.linear_velocity + h * (found.linear + apply(linear, change))
    return State(turn_in_body(state.orientation, w, h), w, state.position + h * v, v)


SCHEME = Scheme(
    name="linearly-implicit-euler",
    title="Linearly implicit Euler, exponential in attitude",
    step=step,
    orders=every_channel(1),
    special={"free": {"linear_momentum": None}},
    source="Hairer, Wanner, Solving Ordinary Differential Equations II (1996), IV.7",
)
