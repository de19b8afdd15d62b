"""Runge-Kutta 4 that averages ω over its stages and turns by the mean: order 2 in attitude."""

from __future__ import annotations

from omegadot.reference_impl.schemes.motion import Motion
from omegadot.reference_impl.schemes.runge_kutta import step_in_exponential
from omegadot.reference_impl.schemes.scheme import Scheme, every_channel
from omegadot.reference_impl.system import Array


def _as_if_rotations_commuted(_: Array, v: Array) -> Array:
    """``u̇ = v``: the commutator ``½ [u, v]`` is missing."""
    return v


_as_if_rotations_commuted.formula = _as_if_rotations_commuted  # type: ignore[attr-defined]


def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    """Stages ``q_i = q₀ exp(h a_i v_{i-1})``, end ``q₁ = q₀ exp(h Σ b_i v_i)``.

    The attitude is of order 2. Where the torque does not depend on the attitude, ω is still of
    order 4, and so is the energy of a free body, which therefore does not show the fault; the
    angular momentum in the world does.
    """
    return step_in_exponential(motion, _as_if_rotations_commuted, q, v, h)


SCHEME = Scheme(
    name="lie-rk4-naive",
    title="Runge-Kutta 4 with the mean of omega in the exponential",
    step=step,
    orders=every_channel(2),
    special={
        "free": {"linear_momentum": None, "position": None},
        "decoupled": {"omega": 4, "energy": 4},
    },
    source="Munthe-Kaas, BIT 35 (1995) 572-587, on the order that commutators cost",
)
