"""Midpoint in the gyroscopic term alone, the loads at the step's start: MuJoCo 3.7 to 3.10."""

from __future__ import annotations

from omegadot.reference_impl.schemes.jacobian import (
    acceleration_and_jacobian,
    natural_size,
    solver_of_one_minus,
)
from omegadot.reference_impl.schemes.motion import Motion, per_matrix
from omegadot.reference_impl.schemes.newton import mean_velocity_of
from omegadot.reference_impl.schemes.scheme import Scheme, every_channel
from omegadot.reference_impl.system import Array


def mean_velocity(motion: Motion, q: Array, v: Array, h: float | Array) -> Array:
    """``v_m = v₀ + h/2 a*``, with a* the accelerations by which the step changes velocities.

    Of what depends on v, the part that is quadratic, and so even, is taken at v_m; the part that
    is linear, and so odd, damping, stays at v₀:
    ``a* = (a(q₀, v_m) + a(q₀, -v_m))/2 + (a(q₀, v₀) - a(q₀, -v₀))/2``. Hence
    ``I (ω₁ - ω₀) = h (τ₀ - ω_m × I ω_m)`` with ``ω_m = (ω₀ + ω₁)/2``.

    v_m is found by Newton's method, see `mean_velocity_of`.
    """
    acceleration, half = motion.acceleration, 0.5 * h
    size = natural_size(motion, v, acceleration(q, v))
    ahead, jacobian = acceleration_and_jacobian(motion, q, v, size)
    ahead, jacobian = ahead.copy(), jacobian.copy()
    back, jacobian_back = acceleration_and_jacobian(motion, q, -v, size)
    odd = 0.5 * (ahead - back)
    solve = solver_of_one_minus(per_matrix(half) * 0.5 * (jacobian - jacobian_back))

    def push(w: Array) -> Array:
        even = 0.5 * acceleration(q, w)
        return half * (even + 0.5 * acceleration(q, -w) + odd)

    return mean_velocity_of(push, half * ahead, v, solve, motion.spin, half)


def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    """``v₁ = 2 v_m - v₀``, ``q₁ = q₀ exp(h ω_m)``, ``p₁ = p₀ + h ṗ₁``.

    A free body without torques keeps ``ωᵀ I ω``, as under the implicit midpoint rule; a torque
    that changes within the step, damping among them, is of order 1. Here the equation is solved
    to rounding; MuJoCo stops at residuals of 2e-13 of the momentum, or of a torque of 1e-13 N m.
    """
    mean = mean_velocity(motion, q, v, h)
    end = 2 * mean - v
    way = end.copy()
    way[..., motion.spin] = mean[..., motion.spin]
    return motion.retract(q, h * way), end


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
    solved_torque=1e-13,
)
