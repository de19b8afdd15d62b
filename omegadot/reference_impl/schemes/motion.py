"""What a scheme steps: accelerations, and the few ways in which configurations move."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from omegadot.reference_impl.system import Array

Velocity = Callable[[Array, Array], Array]  # of (q, v) or (u, v): (..., n)
Turn = Callable[[Array, Array], Array]  # of a quaternion (..., 4) and a rotation vector (..., 3)


def _same(vector: Array) -> Array:
    return vector


def _second(_: Array, v: Array) -> Array:
    return v


def _sum(q: Array, u: Array) -> Array:
    return q + u


@dataclass(frozen=True, slots=True)
class Motion:
    """A system in coordinates: q (..., k) its configuration, v (..., n) its velocities.

    Arrays are plain, with the lanes in front; q and v have the same. Only `acceleration` must be
    given: what else there is defaults to that of a vector space, where q is a vector and ``q̇ = v``.

    acceleration: ``v̇(q, v)``, (..., n), of a unit q. The array may be memory that the next call
    writes over, as that of an engine's may, and so may those of `jacobian`: a scheme uses them up
    before.
    retract: ``q exp(u)``, (..., k): the exponential on the configuration space, u (..., n).
    rate: ``u̇(u, v)``, (..., n), for which ``q₀ exp(u)`` moves with v: the inverse of the
    exponential's differential, ``dexp⁻¹``, in closed form.
    rate_to_second_order: the same as a series, ``v + ½ [u, v] + ¹⁄₁₂ [u, [u, v]]``.
    cayley: the vector whose exponential is Cayley's transform ``(1 - u/2)⁻¹ (1 + u/2)`` of u.
    coordinate_rate: ``q̇(q, v)``, (..., k), linear in the quaternion, which need not be unit.
    normalize: q with its quaternions made unit.
    jacobian: of (q, v, size): ``v̇`` and ``∂v̇/∂v`` (..., n, m) by the last m velocities, if the
    accelerations depend on no others. size: (..., 1), the distance for differences where v itself
    gives none. None: by differences.
    turned_by: of (turn, q, u): `retract` with every quaternion moved by ``turn(quaternion, r)``.
    momentum: of the velocities of `spin`: ``I ω``, (..., m).
    spin: the velocities, of one unit, by which an implicit step is judged to have settled, and
    which `turned_by` turns.
    """

    acceleration: Velocity
    retract: Velocity = _sum
    rate: Velocity = _second
    rate_to_second_order: Velocity = _second
    cayley: Callable[[Array], Array] = _same
    coordinate_rate: Velocity = _second
    normalize: Callable[[Array], Array] = _same
    jacobian: Callable[[Array, Array, Array | None], tuple[Array, Array]] | None = None
    turned_by: Callable[[Turn, Array, Array], Array] | None = None
    momentum: Callable[[Array], Array] = _same
    spin: slice = field(default_factory=lambda: slice(None))


def per_matrix(h: float | Array) -> Any:
    """The step, a float or (..., 1), shaped to multiply matrices (..., n, m)."""
    return h if isinstance(h, float) else h[..., None]


def slope_of(motion: Motion, size: int) -> Callable[[Array], Array]:
    """The derivative of q and v in one vector, (n,), for a general solver of such equations.

    size: of q, the coordinates of which are normalised before accelerations are taken there.
    """

    def slope(y: Array) -> Array:
        q, v = y[:size], y[size:]
        turned = motion.coordinate_rate(q, v)
        return np.concatenate((turned, motion.acceleration(motion.normalize(q), v)))

    return slope
