"""The classical Runge-Kutta method of order 4, and the motion as the plain vectors it takes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from omegadot.reference_impl.rotations import turn_in_body
from omegadot.reference_impl.schemes.scheme import AccelerationOf, per_component
from omegadot.reference_impl.system import Array, State


def runge_kutta_4(rates: Callable[[Array], Array], y: Array, h: float | Array) -> Array:
    """``y + h/6 (k₁ + 2k₂ + 2k₃ + k₄)``: Kutta's method of 1901 on ``ẏ = rates(y)``."""
    k1 = rates(y)
    k2 = rates(y + 0.5 * h * k1)
    k3 = rates(y + 0.5 * h * k2)
    k4 = rates(y + h * k3)
    return y + h / 6 * (k1 + 2 * (k2 + k3) + k4)


def step_in_rotation_vector(
    acceleration: AccelerationOf,
    state: State,
    dt: float | Array,
    vector_rate: Callable[[Array, Array], Array],
) -> State:
    """RK4 on ``y = (u, ω, p, v)`` with ``q = q₀ exp(u)``, u zero at the start of every step.

    vector_rate: u̇ as a function of u and ω, both (..., 3).
    """
    q0 = state.orientation

    def rates(y: Array) -> Array:
        u, w, p, v = (y[..., start : start + 3] for start in (0, 3, 6, 9))
        found = acceleration(State(turn_in_body(q0, u, 1.0), w, p, v))
        return np.concatenate((vector_rate(u, w), found.angular, v, found.linear), axis=-1)

    w, p, v = state.angular_velocity, state.position, state.linear_velocity
    y = np.concatenate((np.zeros_like(w), w, p, v), axis=-1)
    end = runge_kutta_4(rates, y, per_component(dt))
    u, w, p, v = (end[..., start : start + 3] for start in (0, 3, 6, 9))
    return State(turn_in_body(q0, u, 1.0), w, p, v)
