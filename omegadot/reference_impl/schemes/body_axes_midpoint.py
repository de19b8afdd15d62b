"""Midpoint in both momenta, in body axes: MuJoCo 3.7 to 3.10 with the centre of mass off."""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.schemes import frozen_torque_midpoint
from omegadot.reference_impl.schemes.motion import Motion
from omegadot.reference_impl.schemes.scheme import IN_WORLD, Scheme, every_channel
from omegadot.reference_impl.system import Array


def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    """ω and q as frozen-torque-midpoint; ``u₁ - u₀ = h (q₀⁻¹ a* - ω_m × (u₀ + u₁)/2)``.

    ``u = q⁻¹ ṗ`` is a free body's velocity in body axes, ``ṗ₁ = q₁ u₁`` and
    ``p₁ = p₀ + h (ṗ₀ + ṗ₁)/2``. The forces stay in body axes for the step, so that gravity is
    turned by half the step's turn, and as u is turned by Cayley's increment but q by the
    exponential, a steady velocity too is turned: by ``|h ω|³/12`` a step. It knows one body alone:
    q is (position, quaternion), v is (velocity in the world, ω). On a pivot there is no u.
    """
    if v.shape[-1] == 3:
        return frozen_torque_midpoint.step(motion, q, v, h)
    mean = frozen_torque_midpoint.mean_velocity(motion, q, v, h)
    attitude, start, half_turn = q[..., 3:], v[..., :3], 0.5 * h * mean[..., 3:]
    turning = np.concatenate((np.zeros_like(start), mean[..., 3:]), axis=-1)
    turned = motion.retract(q, h * turning)[..., 3:]
    u = rotate_inverse(attitude, start)
    push = 2 * rotate_inverse(attitude, mean[..., :3] - start)
    velocity = rotate(turned, _unturned(u - cross(half_turn, u) + push, half_turn))
    end = np.concatenate((velocity, 2 * mean[..., 3:] - v[..., 3:]), axis=-1)
    place = q[..., :3] + 0.5 * h * (start + velocity)
    return np.concatenate((place, turned), axis=-1), end


def _unturned(b: Array, r: Array) -> Array:
    """The x with ``x + r × x = b``: ``(b - r × b + r (r·b)) / (1 + |r|²)``, (..., 3)."""
    along = np.add.reduce(r * b, -1, keepdims=True)
    x: Array = (b - cross(r, b) + r * along) / (1 + np.add.reduce(r * r, -1, keepdims=True))
    return x


SCHEME = Scheme(
    name="body-axes-midpoint",
    title="Midpoint of both momenta in body axes, loads of the step's start",
    step=step,
    orders=every_channel(1),
    special={"torque-free": {"omega": 2, "attitude": 2, "angular_momentum": 2}},
    source="MuJoCo's changelog, versions 3.7.0 and 3.11.0, the linear velocity by its steps",
    solved_to=3e-13,
    solved_torque=1e-13,
    coordinates=IN_WORLD,
)
