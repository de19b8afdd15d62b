"""The classical explicit Runge-Kutta method of order 4 on the quaternion's own equation."""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.rotations import normalize, quaternion_product
from omegadot.reference_impl.schemes.runge_kutta import runge_kutta_4
from omegadot.reference_impl.schemes.scheme import (
    AccelerationOf,
    Scheme,
    every_channel,
    per_component,
)
from omegadot.reference_impl.system import Array, State


def step(acceleration: AccelerationOf, state: State, dt: float | Array) -> State:
    """RK4 on ``y = (q, ω, p, v)`` with ``q̇ = ½ q (0, ω)``; q is made unit after the step.

    The stages' quaternions leave the unit sphere a little; forces are taken at their directions.
    """

    def rates(y: Array) -> Array:
        q, w, p, v = y[..., :4], y[..., 4:7], y[..., 7:10], y[..., 10:]
        pure = np.zeros(q.shape, q.dtype)
        pure[..., 1:] = 0.5 * w
        found = acceleration(State(normalize(q), w, p, v))
        turning = quaternion_product(q, pure)
        return np.concatenate((turning, found.angular, v, found.linear), axis=-1)

    parts = (state.orientation, state.angular_velocity, state.position, state.linear_velocity)
    end = runge_kutta_4(rates, np.concatenate(parts, axis=-1), per_component(dt))
    return State(normalize(end[..., :4]), end[..., 4:7], end[..., 7:10], end[..., 10:])


SCHEME = Scheme(
    name="rk4-quaternion",
    title="Runge-Kutta 4 on the quaternion, renormalised",
    step=step,
    orders=every_channel(4),
    special={"free": {"linear_momentum": None, "position": None}},
    source="Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), II.1",
)
