"""The classical explicit Runge-Kutta method of order 4 on the quaternion's own equation."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

from omegadot.reference_impl.arithmetic.components import formulas_of
from omegadot.reference_impl.schemes.motion import Motion, Velocity
from omegadot.reference_impl.schemes.runge_kutta import joined, step_coupled
from omegadot.reference_impl.schemes.scheme import Scheme, every_channel
from omegadot.reference_impl.system import Array


def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    """Kutta's method on q and v with q̇ as of any vector: ``½ q (0, ω)`` of a quaternion.

    The stages' quaternions leave the unit sphere a little; accelerations are taken at their
    directions, and they are made unit after the step.
    """
    rate, place = motion.coordinate_rate, _direction(motion.normalize)
    q, v = step_coupled(rate, motion.acceleration, place, q, joined(q, v), rate(q, v), h)
    return motion.normalize(q), v


@lru_cache(maxsize=8)
def _direction(unit: Callable[[Array], Array]) -> Velocity:
    """`unit` of the second of two configurations, in components where it is made of such."""

    def of_second(_: Array, q: Array) -> Array:
        return unit(q)

    formulas = formulas_of(unit)
    if formulas is not None:
        of_second.formula = lambda _, q: formulas[0](q)  # type: ignore[attr-defined]
    return of_second


SCHEME = Scheme(
    name="rk4-quaternion",
    title="Runge-Kutta 4 on the quaternion, renormalised",
    step=step,
    orders=every_channel(4),
    special={"free": {"linear_momentum": None, "position": None}},
    source="Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), II.1",
)
