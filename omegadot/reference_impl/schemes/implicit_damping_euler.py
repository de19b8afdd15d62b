"""Semi-implicit Euler with implicit damping: the gyroscopic term at the step's start."""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.schemes.jacobian import (
    acceleration_and_jacobian,
    natural_size,
    solve_one_minus,
)
from omegadot.reference_impl.schemes.motion import Motion, per_matrix
from omegadot.reference_impl.schemes.scheme import Scheme, every_channel
from omegadot.reference_impl.system import Array


def pushed(motion: Motion, q: Array, v: Array, h: float | Array) -> Array:
    """The v₁ of ``(1 - h J₀) (v₁ - v₀) = h v̇`` with ``J₀ = ∂v̇/∂v`` at v = 0.

    By equation (8) with a viscous torque ``J₀ = -d I⁻¹``, so that ``(I + h d) Δω = h I ω̇``: at
    rest the gyroscopic term, being quadratic, has no derivative.
    """
    a = motion.acceleration(q, v)
    push, size = h * a, natural_size(motion, v, a)
    _, jacobian = acceleration_and_jacobian(motion, q, np.zeros_like(v), size)
    found: Array = v + solve_one_minus(per_matrix(h) * jacobian, push)
    return found


def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    """``pushed``, then as semi-implicit Euler, which it is without damping."""
    v = pushed(motion, q, v, h)
    return motion.retract(q, h * v), v


SCHEME = Scheme(
    name="implicit-damping-euler",
    title="Semi-implicit Euler with implicit damping, exponential in attitude",
    step=step,
    orders=every_channel(1),
    special={"free": {"linear_momentum": None}},
    source="MuJoCo documentation, Computation, Numerical integration",
)
