"""Semi-implicit (symplectic) Euler with the exponential on SO(3): velocities first, then places."""

from __future__ import annotations

from omegadot.reference_impl.rotations import turn_in_body
from omegadot.reference_impl.schemes.scheme import (
    AccelerationOf,
    Scheme,
    every_channel,
    per_component,
)
from omegadot.reference_impl.system import Array, State


def step(acceleration: AccelerationOf, state: State, dt: float | Array) -> State:
    """``ω₁ = ω₀ + h ω̇(q₀, ω₀)``, ``q₁ = q₀ exp(h ω₁)``, ``v₁ = v₀ + h a``, ``p₁ = p₀ + h v₁``.

    On a free body the step in ω is plain explicit Euler: the name speaks of places and velocities.
    """
    h = per_component(dt)
    found = acceleration(state)
    w = state.angular_velocity + h * found.angular
    v = state.linear_velocity + h * found.linear
    return State(turn_in_body(state.orientation, w, h), w, state.position + h * v, v)


SCHEME = Scheme(
    name="semi-implicit-euler",
    title="Semi-implicit Euler, exponential in attitude",
    step=step,
    orders=every_channel(1),
    special={"free": {"linear_momentum": None}},
    source="Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), I.1.2 and IV.8",
)
