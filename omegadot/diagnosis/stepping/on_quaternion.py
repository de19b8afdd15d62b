"""Runge-Kutta methods on the quaternion's own equation, whatever their tableau."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.schemes.scheme import Step
from omegadot.reference_impl.system import Array

Rows = Sequence[Sequence[float]]
Rate = Callable[[Motion, Array, Array], Array]


def at_unit(motion: Motion, q: Array, v: Array) -> Array:
    """The acceleration at the unit quaternion of the same direction."""
    return motion.acceleration(motion.normalize(q), v)


def on_quaternion(
    rows: Rows,
    weights: Sequence[float],
    loads_of: Sequence[int] = (),
    rates_of: Sequence[int] = (),
    rate: Rate = at_unit,
) -> Step:
    """An explicit method, whose quaternion is made unit after the step.

    loads_of, rates_of: of each stage, the one whose attitude the loads are taken at, and the one
    whose omega-dot it takes; its own where they are not given.
    """

    def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
        slopes, places = list[tuple[Array, Array]](), list[Array]()
        for stage, row in enumerate(rows):
            at_q = q + sum((a * h) * k for a, (k, _) in zip(row, slopes, strict=True))
            at_v = v + sum((a * h) * k for a, (_, k) in zip(row, slopes, strict=True))
            places.append(at_q)
            if rates_of and rates_of[stage] < stage:
                acceleration = slopes[rates_of[stage]][1]
            else:
                place = places[loads_of[stage]] if loads_of else at_q
                acceleration = np.array(rate(motion, place, at_v))
            slopes.append((motion.coordinate_rate(at_q, at_v), acceleration))
        q = q + h * sum(b * k for b, (k, _) in zip(weights, slopes, strict=True))
        v = v + h * sum(b * k for b, (_, k) in zip(weights, slopes, strict=True))
        return motion.normalize(q), np.asarray(v)

    return step
