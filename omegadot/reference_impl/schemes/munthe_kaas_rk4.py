"""Runge-Kutta 4 after Munthe-Kaas with the inverse of dexp in closed form."""

from __future__ import annotations

from omegadot.reference_impl.schemes.motion import Motion
from omegadot.reference_impl.schemes.runge_kutta import step_in_exponential
from omegadot.reference_impl.schemes.scheme import IN_WORLD, Scheme, every_channel
from omegadot.reference_impl.system import Array


def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    """RK4 on u of ``q = q₀ exp(u)``, whose rate is the motion's, and v."""
    return step_in_exponential(motion, motion.rate, q, v, h)


SCHEME = Scheme(
    name="munthe-kaas-rk4",
    title="Runge-Kutta-Munthe-Kaas 4, dexp inverse in closed form",
    step=step,
    orders=every_channel(4),
    special={"free": {"linear_momentum": None, "position": None}},
    source="Munthe-Kaas, BIT 38 (1998) 92-111; Iserles et al., Acta Numerica 9 (2000), section 4",
    coordinates=IN_WORLD,
)
