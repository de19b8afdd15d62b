"""Midpoint in the gyroscopic term alone, the loads at the step's start: MuJoCo 3.7 to 3.10."""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.rotations import turn_in_body
from omegadot.reference_impl.schemes.jacobian import (
    acceleration_and_jacobian,
    inverse_of_one_minus,
)
from omegadot.reference_impl.schemes.newton import mean_velocity_of
from omegadot.reference_impl.schemes.scheme import (
    AccelerationOf,
    Scheme,
    every_channel,
    per_component,
)
from omegadot.reference_impl.system import Acceleration, Array, State


def mean_velocity(
    acceleration: AccelerationOf, state: State, h: float | Array
) -> tuple[Array, Acceleration]:
    """``ω_m = ω₀ + h/2 ω̇*`` and the accelerations ``a*`` by which the step changes velocities.

    Of what depends on ω, the part that is quadratic, and so even, is taken at ω_m; the part that
    is linear, and so odd, damping, stays at ω₀:
    ``a* = (a(q₀, ω_m) + a(q₀, -ω_m))/2 + (a(q₀, ω₀) - a(q₀, -ω₀))/2``. Hence
    ``I (ω₁ - ω₀) = h (τ₀ - ω_m × I ω_m)`` with ``ω_m = (ω₀ + ω₁)/2``.

    ω_m is found by Newton's method, see `mean_velocity_of`.
    """
    w0, half = state.angular_velocity, 0.5 * h
    turn = half if isinstance(half, float) else half[..., None]
    even, odd = _even_and_odd(acceleration, state)
    rate = _natural_rate(w0, even.angular + odd.angular)

    def starred(at: State) -> Acceleration:
        even, _ = _even_and_odd(acceleration, at)
        return Acceleration(even.angular + odd.angular, even.linear + odd.linear)

    found, jacobian, _ = acceleration_and_jacobian(starred, state, rate)
    inverse = inverse_of_one_minus(turn * jacobian)

    def evaluate(w: Array, _: Acceleration) -> Acceleration:
        return starred(_with_velocity(state, w))

    return mean_velocity_of(evaluate, found, w0, half, inverse)


def _even_and_odd(acceleration: AccelerationOf, state: State) -> tuple[Acceleration, Acceleration]:
    """``(a(ω) + a(-ω))/2`` and ``(a(ω) - a(-ω))/2`` at one attitude, in one call."""
    w = state.angular_velocity
    q, x, v = state.orientation, state.position, state.linear_velocity
    found = acceleration(State(*(np.array(pair) for pair in ([q, q], [w, -w], [x, x], [v, v]))))
    (w_dot, w_dot_back), (pull, pull_back) = found.angular, found.linear
    even = Acceleration(0.5 * (w_dot + w_dot_back), 0.5 * (pull + pull_back))
    return even, Acceleration(0.5 * (w_dot - w_dot_back), 0.5 * (pull - pull_back))


def _natural_rate(w: Array, omega_dot: Array) -> Array:
    """(..., 1) rad/s: ``(|ω|² + |ω̇|)^½``, which like ω scales with the unit of time."""
    spin, pull = np.add.reduce(w * w, -1), np.add.reduce(omega_dot * omega_dot, -1)
    rate: Array = np.sqrt(spin + np.sqrt(pull))[..., None]
    return rate


def _with_velocity(state: State, w: Array) -> State:
    return State(state.orientation, w, state.position, state.linear_velocity)


def step(acceleration: AccelerationOf, state: State, dt: float | Array) -> State:
    """``ω₁ = 2 ω_m - ω₀``, ``q₁ = q₀ exp(h ω_m)``, ``v₁ = v₀ + h a*``, ``p₁ = p₀ + h v₁``.

    A free body without torques keeps ``ωᵀ I ω``, as under the implicit midpoint rule; a torque
    that changes within the step, damping among them, is of order 1. Here the equation is solved
    to rounding; MuJoCo stops at residuals of some 2e-13 of the momentum.
    """
    h = per_component(dt)
    mean, found = mean_velocity(acceleration, state, h)
    v = state.linear_velocity + h * found.linear
    return State(
        turn_in_body(state.orientation, mean, h),
        2 * mean - state.angular_velocity,
        state.position + h * v,
        v,
    )


SCHEME = Scheme(
    name="frozen-torque-midpoint",
    title="Midpoint in the gyroscopic term, exponential in attitude, torques of the step's start",
    step=step,
    orders=every_channel(1),
    special={
        "free": {"linear_momentum": None},
        "torque-free": {"omega": 2, "attitude": 2, "angular_momentum": 2},
    },
    source="MuJoCo's changelog, versions 3.7.0 and 3.11.0, confirmed by its steps",
    solved_to=3e-13,
)
