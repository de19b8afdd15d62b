"""Implicit midpoint with Cayley's increment: keeps a free body's energy and momentum."""

from __future__ import annotations

from omegadot.reference_impl.schemes.jacobian import acceleration_and_jacobian, solver_of_one_minus
from omegadot.reference_impl.schemes.motion import Motion, per_matrix
from omegadot.reference_impl.schemes.newton import mean_velocity_of
from omegadot.reference_impl.schemes.scheme import Scheme, every_channel
from omegadot.reference_impl.system import Array


def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    """``v₁ = v₀ + h v̇(q_m, v_m)``, ``v_m = (v₀ + v₁)/2``, ``q₁ = q₀ cay(h v_m)``.

    q_m lies half the increment from q₀ and from q₁, so the step is its own inverse with -h. For a
    free body ``I(ω₁ - ω₀) = -h ω_m × I ω_m``, which keeps ``ωᵀ I ω``, and written as
    ``(1 + h ω_m×/2) I ω₁ = (1 - h ω_m×/2) I ω₀`` it is ``R₁ I ω₁ = R₀ I ω₀``: the momentum.

    v_m is found by Newton's method, see `mean_velocity_of`.
    """
    acceleration, retract, cayley = motion.acceleration, motion.retract, motion.cayley
    half = 0.5 * h
    a, jacobian = acceleration_and_jacobian(motion, q, v)
    solve = solver_of_one_minus(per_matrix(half) * jacobian)

    def push(w: Array) -> Array:
        return half * acceleration(retract(q, 0.5 * cayley(h * w)), w)

    w = mean_velocity_of(push, half * a, v, solve, motion.spin, h)
    return retract(q, cayley(h * w)), 2 * w - v


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
