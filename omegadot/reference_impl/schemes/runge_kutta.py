"""The classical Runge-Kutta method of order 4 in exponential coordinates."""

from __future__ import annotations

from omegadot.reference_impl.schemes.motion import Motion, Velocity
from omegadot.reference_impl.system import Array


def step_in_exponential(
    motion: Motion, rate: Velocity, q: Array, v: Array, h: float | Array
) -> tuple[Array, Array]:
    """Kutta's method of 1901 on u and v with ``q = q₀ exp(u)``, u zero at the step's start.

    rate: u̇ as a function of u and v, which at u = 0 is v.
    """
    acceleration, retract = motion.acceleration, motion.retract
    half = 0.5 * h
    a = h * acceleration(q, v)
    v2 = v + 0.5 * a
    u = half * v
    u2 = rate(u, v2)
    b = h * acceleration(retract(q, u), v2)
    v3 = v + 0.5 * b
    u = half * u2
    u3 = rate(u, v3)
    c = h * acceleration(retract(q, u), v3)
    v4 = v + c
    u = h * u3
    u4 = rate(u, v4)
    d = h * acceleration(retract(q, u), v4)
    u = h / 6 * (v + 2 * (u2 + u3) + u4)
    return retract(q, u), v + (a + 2 * (b + c) + d) / 6
