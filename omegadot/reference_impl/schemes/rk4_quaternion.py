"""The classical explicit Runge-Kutta method of order 4 on the quaternion's own equation."""

from __future__ import annotations

from omegadot.reference_impl.schemes.motion import Motion
from omegadot.reference_impl.schemes.scheme import Scheme, every_channel
from omegadot.reference_impl.system import Array


def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    """Kutta's method of 1901 on q and v with q̇ as of any vector: ``½ q (0, ω)`` of a quaternion.

    The stages' quaternions leave the unit sphere a little; accelerations are taken at their
    directions, and they are made unit after the step.
    """
    acceleration, unit, rate = motion.acceleration, motion.normalize, motion.coordinate_rate
    half = 0.5 * h
    a, r1 = half * acceleration(q, v), rate(q, v)
    q2, v2 = q + half * r1, v + a
    b, r2 = half * acceleration(unit(q2), v2), rate(q2, v2)
    q3, v3 = q + half * r2, v + b
    c, r3 = h * acceleration(unit(q3), v3), rate(q3, v3)
    q4, v4 = q + h * r3, v + c
    d, r4 = half * acceleration(unit(q4), v4), rate(q4, v4)
    middle = r2 + r3
    end = q + h / 6 * (r1 + middle + middle + r4)
    return unit(end), v + (a + b + b + c + d) / 3


SCHEME = Scheme(
    name="rk4-quaternion",
    title="Runge-Kutta 4 on the quaternion, renormalised",
    step=step,
    orders=every_channel(4),
    special={"free": {"linear_momentum": None, "position": None}},
    source="Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), II.1",
)
