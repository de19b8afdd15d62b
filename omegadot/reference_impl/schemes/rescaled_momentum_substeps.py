"""Momentum turned at its length in four substeps, the push held in the world: Rapier's step."""

from __future__ import annotations

from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.schemes.motion import Motion
from omegadot.reference_impl.schemes.rescaled_momentum_euler import by_terms, kept_long
from omegadot.reference_impl.schemes.scheme import Scheme, every_channel
from omegadot.reference_impl.system import Array

SUBSTEPS = 4  # Rapier's IntegrationParameters.num_solver_iterations


def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    """Four times with h/4: ``ω' = ω + h/4 α``, then ω' turned as L is, then Q by ω.

    ``L' = (L - h/4 ω' × L) |L| / |L - h/4 ω' × L|`` with ``L = I ω'``, as in
    semi-implicit-euler-rescaled-momentum. What torque adds to ω is formed once and stays in world
    axes: ``α = R_kᵀ R₀ I⁻¹ τ(q₀, v₀)`` in the substep that starts at attitude R_k. The turn is a
    straight step of the quaternion, ``Q + Q (0, h/4 ω)/2`` made unit, which is Cayley's increment:
    by ``2 atan(r/2)`` in place of ``r = h |ω|/4``. It knows one body alone: q ends in the
    quaternion.
    """
    part = h / SUBSTEPS
    _, rest = by_terms(motion, q, v)
    push = rotate(q[..., -4:], rest[..., motion.spin])
    for _ in range(SUBSTEPS):
        rest[..., motion.spin] = rotate_inverse(q[..., -4:], push)
        v = v + part * rest
        gyroscopic, _ = by_terms(motion, q, v)
        v[..., motion.spin] = kept_long(motion, v[..., motion.spin], part * gyroscopic)
        q = motion.retract(q, motion.cayley(part * v))
    return q, v


SCHEME = Scheme(
    name="semi-implicit-euler-rescaled-momentum-four-substeps",
    title="Momentum turned at its length in four substeps, straight in the quaternion",
    step=step,
    orders=every_channel(1),
    special={"free": {"linear_momentum": None}},
    source="Rapier (IntegrationParameters, num_solver_iterations), confirmed by its steps",
    coordinates=("com-world",),
)
