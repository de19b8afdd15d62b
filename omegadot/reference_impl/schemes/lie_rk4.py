"""Runge-Kutta 4 on the rotation group after Munthe-Kaas: order 4 in attitude too."""

from __future__ import annotations

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.schemes.runge_kutta import step_in_rotation_vector
from omegadot.reference_impl.schemes.scheme import AccelerationOf, Scheme, every_channel
from omegadot.reference_impl.system import Array, State


def vector_rate(u: Array, w: Array) -> Array:
    """``u̇ = ω + ½ u × ω + ¹⁄₁₂ u × (u × ω)``, (..., 3): how ``exp(u)`` must move to turn with ω.

    The series of dexp⁻¹ for ``q = q₀ exp(u)`` and ω in the body frame, without its terms from
    ``|u|⁴ ω`` on; u is of the size h, so that they touch the step at h⁵ alone.
    """
    turned = cross(u, w)
    return w + 0.5 * turned + cross(u, turned) / 12


def step(acceleration: AccelerationOf, state: State, dt: float | Array) -> State:
    """RK4 on the rotation vector u of ``q = q₀ exp(u)``, whose rate is `vector_rate`, and ω."""
    return step_in_rotation_vector(acceleration, state, dt, vector_rate)


SCHEME = Scheme(
    name="lie-rk4",
    title="Runge-Kutta-Munthe-Kaas 4",
    step=step,
    orders=every_channel(4),
    special={"free": {"linear_momentum": None, "position": None}},
    source="Munthe-Kaas, BIT 38 (1998) 92-111; Iserles et al., Acta Numerica 9 (2000), section 4",
)
