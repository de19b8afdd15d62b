"""Semi-implicit (symplectic) Euler with the exponential: velocities first, then places."""

from __future__ import annotations

from omegadot.reference_impl.schemes.motion import Motion
from omegadot.reference_impl.schemes.scheme import Scheme, every_channel
from omegadot.reference_impl.system import Array


def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    """``v₁ = v₀ + h v̇(q₀, v₀)``, ``q₁ = q₀ exp(h v₁)``.

    On a free body the step in ω is plain explicit Euler: the name refers to places and velocities.
    """
    v = v + h * motion.acceleration(q, v)
    return motion.retract(q, h * v), v


SCHEME = Scheme(
    name="semi-implicit-euler",
    title="Semi-implicit Euler, exponential in attitude",
    step=step,
    orders=every_channel(1),
    special={"free": {"linear_momentum": None}},
    source="Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), I.1.2 and IV.8",
)
