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
    a = half * acceleration(q, v)
    v2 = v + a
    u = half * v
    u2 = rate(u, v2)
    b = half * acceleration(retract(q, u), v2)
    v3 = v + b
    u = half * u2
    u3 = rate(u, v3)
    c = h * acceleration(retract(q, u), v3)
    v4 = v + c
    u = h * u3
    u4 = rate(u, v4)
    d = half * acceleration(retract(q, u), v4)
    middle = u2 + u3
    u = h / 6 * (v + middle + middle + u4)
    return retract(q, u), v + (a + b + b + c + d) / 3
