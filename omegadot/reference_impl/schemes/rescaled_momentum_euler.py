"""Semi-implicit Euler that turns the angular momentum and keeps its length, as Jolt and Rapier."""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.schemes.motion import Motion
from omegadot.reference_impl.schemes.scheme import Scheme, every_channel
from omegadot.reference_impl.system import Array


def by_terms(motion: Motion, q: Array, v: Array) -> tuple[Array, Array]:
    """The gyroscopic part of v̇ in ω, ``-I⁻¹ (ω × I ω)``, and all the rest of v̇.

    The first is what is quadratic in ω: ``(a(q, v) + a(q, -v))/2 - a(q, 0)``.
    """
    ahead = np.array(motion.acceleration(q, v))
    both = 0.5 * (ahead + motion.acceleration(q, -v))
    gyroscopic: Array = (both - motion.acceleration(q, np.zeros_like(v)))[..., motion.spin]
    ahead[..., motion.spin] -= gyroscopic
    return gyroscopic, ahead


def kept_long(motion: Motion, w: Array, change: Array) -> Array:
    """``|I ω| / |I (ω + Δω)| (ω + Δω)``: the changed ω with the old length of ``I ω``."""
    changed: Array = w + change
    length = _length(motion.momentum(changed))
    lasts = length > 0  # else no length can be given to it
    return changed * np.where(lasts, _length(motion.momentum(w)) / np.where(lasts, length, 1), 1)


def _length(vector: Array) -> Array:
    square: Array = np.add.reduce(vector * vector, -1, keepdims=True)
    return np.sqrt(square)


def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    """``L' = (L - h ω × L) |L| / |L - h ω × L|``, ``ω₁ = I⁻¹ (L' + h τ)``, ``q₁ = q₀ exp(h v₁)``.

    L = I ω and the torque τ, all but the gyroscopic one, are those of the step's start. The motion
    of the centre of mass is that of semi-implicit Euler. Without torque |L| is kept, in whatever
    direction, so that ω stays bounded at any step; energy drifts in first order,
    ``dE/dt = h/2 (n·I⁻¹ n - 2 E |n|²/|L|²)`` with ``n = ω × L``.

    The engines step free bodies. On a pivot L is that about the pivot, and weight a part of τ.
    """
    gyroscopic, rest = by_terms(motion, q, v)
    end = v + h * rest
    turned = kept_long(motion, v[..., motion.spin], h * gyroscopic)
    end[..., motion.spin] = turned + h * rest[..., motion.spin]
    return motion.retract(q, h * end), end


SCHEME = Scheme(
    name="semi-implicit-euler-rescaled-momentum",
    title="Semi-implicit Euler, the angular momentum turned at its length",
    step=step,
    orders=every_channel(1),
    special={"free": {"linear_momentum": None}},
    source=(
        "Jolt (MotionProperties.inl, ApplyGyroscopicForceInternal) and Rapier "
        "(angvel_with_gyroscopic_forces), confirmed by their steps"
    ),
    coordinates=("com-world",),
)
