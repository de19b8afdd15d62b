"""Runge-Kutta 4 after Munthe-Kaas with the inverse of dexp in closed form."""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.schemes.runge_kutta import step_in_rotation_vector
from omegadot.reference_impl.schemes.scheme import AccelerationOf, Scheme, every_channel
from omegadot.reference_impl.system import Array, State


def vector_rate(u: Array, w: Array) -> Array:
    """``u̇ = ω + ½ u × ω + c u × (u × ω)``, ``c = (1 - ½|u| cot ½|u|) / |u|²``, (..., 3).

    dexp⁻¹ for ``q = q₀ exp(u)`` and ω in the body frame, for |u| below 2π. Towards zero c tends to
    ¹⁄₁₂ and is lost to rounding, which leaves no mark: it multiplies |u|².
    """
    square = np.add.reduce(u * u, -1, keepdims=True)
    half = 0.5 * np.sqrt(np.maximum(square, 1e-30))
    c = (1 - half / np.tan(half)) / (4 * half * half)
    turned = cross(u, w)
    rate: Array = w + 0.5 * turned + c * cross(u, turned)
    return rate


def step(acceleration: AccelerationOf, state: State, dt: float | Array) -> State:
    """RK4 on the rotation vector u of ``q = q₀ exp(u)``, whose rate is `vector_rate`, and ω."""
    return step_in_rotation_vector(acceleration, state, dt, vector_rate)


SCHEME = Scheme(
    name="munthe-kaas-rk4",
    title="Runge-Kutta-Munthe-Kaas 4, dexp inverse in closed form",
    step=step,
    orders=every_channel(4),
    special={"free": {"linear_momentum": None, "position": None}},
    source="Munthe-Kaas, BIT 38 (1998) 92-111; Iserles et al., Acta Numerica 9 (2000), section 4",
)
