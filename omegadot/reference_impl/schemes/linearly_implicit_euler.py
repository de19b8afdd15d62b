"""Linearly implicit Euler: one Newton step of the implicit Euler rule in the velocities."""

from __future__ import annotations

from omegadot.reference_impl.schemes.jacobian import acceleration_and_jacobian, solve_one_minus
from omegadot.reference_impl.schemes.motion import Motion, per_matrix
from omegadot.reference_impl.schemes.scheme import Scheme, every_channel
from omegadot.reference_impl.system import Array


def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    """``(1 - h J) Δv = h v̇`` with ``J = ∂v̇/∂v`` at fixed q, then ``q₁ = q₀ exp(h v₁)``."""
    a, jacobian = acceleration_and_jacobian(motion, q, v)
    v = v + solve_one_minus(per_matrix(h) * jacobian, h * a)
    return motion.retract(q, h * v), v


SCHEME = Scheme(
    name="linearly-implicit-euler",
    title="Linearly implicit Euler, exponential in attitude",
    step=step,
    orders=every_channel(1),
    special={"free": {"linear_momentum": None}},
    source="Hairer, Wanner, Solving Ordinary Differential Equations II (1996), IV.7",
)
