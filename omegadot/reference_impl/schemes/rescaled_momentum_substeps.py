"""The same in four substeps, as Rapier has by default: the torque stays in the world meanwhile."""

from __future__ import annotations

from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.schemes.motion import Motion
from omegadot.reference_impl.schemes.rescaled_momentum_euler import by_terms, kept_long
from omegadot.reference_impl.schemes.scheme import Scheme, every_channel
from omegadot.reference_impl.system import Array

SUBSTEPS = 4  # Rapier's IntegrationParameters.num_solver_iterations


def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    """Four steps of h/4 of semi-implicit-euler-rescaled-momentum, with τ in world axes constant.

    ``τ_k = R_kᵀ R₀ τ(q₀, v₀)`` in the substep that starts at attitude R_k: an engine that takes
    torques in world axes knows no others until the step is over. It knows one body alone: q ends
    in the quaternion.
    """
    part = h / SUBSTEPS
    _, rest = by_terms(motion, q, v)
    torque = rotate(q[..., -4:], motion.momentum(rest[..., motion.spin]))
    for _ in range(SUBSTEPS):
        gyroscopic, _ = by_terms(motion, q, v)
        push = motion.from_momentum(rotate_inverse(q[..., -4:], torque))
        turned = kept_long(motion, v[..., motion.spin], part * gyroscopic)
        v = v + part * rest
        v[..., motion.spin] = turned + part * push
        q = motion.retract(q, part * v)
    return q, v


SCHEME = Scheme(
    name="semi-implicit-euler-rescaled-momentum-four-substeps",
    title="The same in four substeps, the torque of the step's start in world axes",
    step=step,
    orders=every_channel(1),
    special={"free": {"linear_momentum": None}},
    source="Rapier (IntegrationParameters, num_solver_iterations), confirmed by its steps",
    coordinates=("com-world",),
)
