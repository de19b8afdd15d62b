"""Implicit midpoint with Cayley's increment: keeps a free body's energy and momentum."""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.rotations import normalize, quaternion_product
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


def cayley(turn: Array) -> Array:
    """``(1, turn/2) / |(1, turn/2)|``, (..., 3) to (..., 4): the rotation by ``2 atan(|turn|/2)``.

    As a matrix it is ``(1 - turn_×/2)⁻¹ (1 + turn_×/2)``, the midpoint rule's own exponential.
    """
    q = np.ones((*turn.shape[:-1], 4), turn.dtype)
    q[..., 1:] = 0.5 * turn
    return normalize(q)


def _halfway(q: Array, increment: Array) -> Array:
    """``q`` turned by half the increment, whose root is ``1 + increment`` made unit."""
    root = increment.copy()
    root[..., 0] += 1
    return quaternion_product(q, normalize(root))


def _midpoint(state: State, w: Array, h: float | Array, linear: Array) -> State:
    return State(
        _halfway(state.orientation, cayley(h * w)),
        w,
        state.position + 0.5 * h * (state.linear_velocity + 0.5 * h * linear),
        state.linear_velocity + 0.5 * h * linear,
    )


def step(acceleration: AccelerationOf, state: State, dt: float | Array) -> State:
    """``ω₁ = ω₀ + h ω̇(q_m, ω_m)``, ``ω_m = (ω₀ + ω₁)/2``, ``q₁ = q₀ cay(h ω_m)``.

    q_m lies half the increment's angle from q₀ and from q₁, so the step is its own inverse with
    -h. For a free body ``I(ω₁ - ω₀) = -h ω_m × I ω_m``, which keeps ``ωᵀ I ω``, and written as
    ``(1 + h ω_m×/2) I ω₁ = (1 - h ω_m×/2) I ω₀`` it is ``R₁ I ω₁ = R₀ I ω₀``: the momentum.

    ω_m is found by Newton's method, see `mean_velocity_of`.
    """
    h = per_component(dt)
    w0, half = state.angular_velocity, 0.5 * h
    found, jacobian, _ = acceleration_and_jacobian(acceleration, state)
    inverse = inverse_of_one_minus(
        (half if isinstance(half, float) else half[..., None]) * jacobian
    )

    def evaluate(w: Array, before: Acceleration) -> Acceleration:
        return acceleration(_midpoint(state, w, h, before.linear))

    w, found = mean_velocity_of(evaluate, found, w0, half, inverse)
    v = state.linear_velocity + h * found.linear
    return State(
        quaternion_product(state.orientation, cayley(h * w)),
        2 * w - w0,
        state.position + half * (state.linear_velocity + v),
        v,
    )


SCHEME = Scheme(
    name="implicit-midpoint",
    title="Implicit midpoint, Cayley in attitude",
    step=step,
    orders=every_channel(2),
    special={
        "free": {"linear_momentum": None, "position": None},
        "torque-free": {"energy": None, "angular_momentum": None},
    },
    source="Austin, Krishnaprasad, Wang, J. Comput. Phys. 107 (1993) 105-117; "
    "Simo, Wong, Int. J. Numer. Meth. Eng. 31 (1991) 19-52",
)
