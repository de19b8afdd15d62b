"""Runge-Kutta 4 on the rotation group after Munthe-Kaas: order 4 in attitude too."""

from __future__ import annotations

from omegadot.reference_impl.schemes.motion import Motion
from omegadot.reference_impl.schemes.runge_kutta import step_in_exponential
from omegadot.reference_impl.schemes.scheme import Scheme, every_channel
from omegadot.reference_impl.system import Array


def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    """RK4 on u of ``q = q₀ exp(u)`` and v with ``u̇ = v + ½ [u, v] + ¹⁄₁₂ [u, [u, v]]``.

    The series of dexp⁻¹ lacks its terms from ``|u|⁴ v`` on; u is of the size h, so that they touch
    the step at h⁵ alone.
    """
    return step_in_exponential(motion, motion.rate_to_second_order, q, v, h)


SCHEME = Scheme(
    name="lie-rk4",
    title="Runge-Kutta-Munthe-Kaas 4",
    step=step,
    orders=every_channel(4),
    special={"free": {"linear_momentum": None, "position": None}},
    source="Munthe-Kaas, BIT 38 (1998) 92-111; Iserles et al., Acta Numerica 9 (2000), section 4",
)
