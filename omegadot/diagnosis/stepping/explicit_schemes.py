"""Explicit schemes that engines have and the reference has not, for the runs of unknown ones."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from omegadot.diagnosis.stepping.on_quaternion import Rows, on_quaternion
from omegadot.reference_impl.schemes import SCHEMES, Motion, Scheme
from omegadot.reference_impl.schemes.scheme import Step, every_channel
from omegadot.reference_impl.system import Array

# Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), II.1.
TABLEAUS: Mapping[str, tuple[int, Rows, Sequence[float]]] = {
    "explicit Euler": (1, ((),), (1.0,)),
    "the explicit midpoint method": (2, ((), (0.5,)), (0.0, 1.0)),
    "Heun's method": (2, ((), (1.0,)), (0.5, 0.5)),
    "Ralston's method": (2, ((), (2 / 3,)), (0.25, 0.75)),
    "Kutta's third-order method": (3, ((), (0.5,), (-1.0, 2.0)), (1 / 6, 2 / 3, 1 / 6)),
    "Heun's third-order method": (3, ((), (1 / 3,), (0.0, 2 / 3)), (0.25, 0.0, 0.75)),
    "Ralston's third-order method": (3, ((), (0.5,), (0.0, 0.75)), (2 / 9, 1 / 3, 4 / 9)),
    "Shu and Osher's third-order method": (3, ((), (1.0,), (0.25, 0.25)), (1 / 6, 1 / 6, 2 / 3)),
    "Kutta's 3/8 method": (
        4,
        ((), (1 / 3,), (-1 / 3, 1.0), (1.0, -1.0, 1.0)),
        (1 / 8, 3 / 8, 3 / 8, 1 / 8),
    ),
}


def by_exponential(rows: Rows, weights: Sequence[float]) -> Step:
    """A Runge-Kutta method whose stages and step turn by the exponential of a weighted omega."""

    def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
        slopes = list[tuple[Array, Array]]()
        for row in rows:
            u: Array = np.zeros_like(v)
            at_v: Array = v
            for a, (moved, pushed) in zip(row, slopes, strict=True):
                u = np.asarray(u + (a * h) * moved)
                at_v = np.asarray(at_v + (a * h) * pushed)
            at_q = motion.retract(q, u) if row else q
            slopes.append((at_v, np.array(motion.acceleration(at_q, at_v))))
        whole = h * sum(b * k for b, (k, _) in zip(weights, slopes, strict=True))
        v = v + h * sum(b * k for b, (_, k) in zip(weights, slopes, strict=True))
        return motion.retract(q, np.asarray(whole)), np.asarray(v)

    return step


def _kick(motion: Motion, q: Array, v: Array, h: float | Array, stages: int) -> Array:
    """The velocities alone, by Euler's method or by Heun's."""
    first = np.array(motion.acceleration(q, v))
    if stages == 1:
        return np.asarray(v + h * first)
    return np.asarray(v + 0.5 * h * (first + motion.acceleration(q, v + h * first)))


def _kick_drift_kick(stages: int) -> Step:
    def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
        v = _kick(motion, q, v, 0.5 * h, stages)
        q = motion.retract(q, h * v)
        return q, _kick(motion, q, v, 0.5 * h, stages)

    return step


def _drift_kick_drift(stages: int) -> Step:
    def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
        q = motion.retract(q, 0.5 * h * v)
        v = _kick(motion, q, v, h, stages)
        return motion.retract(q, 0.5 * h * v), v

    return step


def straight(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    """Semi-implicit Euler with one straight step of the quaternion, which is then made unit."""
    v = v + h * motion.acceleration(q, v)
    return motion.normalize(q + h * motion.coordinate_rate(q, v)), v


def drift_first(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    """Semi-implicit Euler the other way: the place by the old velocity, then the velocity there."""
    q = motion.retract(q, h * v)
    return q, v + h * motion.acceleration(q, v)


def _schemes() -> dict[str, Scheme]:
    found = list[tuple[str, int, Step]]()
    found.append(("semi-implicit Euler on the quaternion", 1, straight))
    found.append(("semi-implicit Euler, places before velocities", 1, drift_first))
    for name, (order, rows, weights) in TABLEAUS.items():
        found.append((f"{name} on the quaternion", order, on_quaternion(rows, weights)))
        if order < 3:
            found.append((f"{name} with the exponential", order, by_exponential(rows, weights)))
    for stages, named in ((1, "Euler"), (2, "Heun")):
        found.append((f"kick-drift-kick, kicks by {named}", 2, _kick_drift_kick(stages)))
        found.append((f"drift-kick-drift, the kick by {named}", 2, _drift_kick_drift(stages)))
    return {name: Scheme(name, name, step, every_channel(order)) for name, order, step in found}


EXPLICIT = _schemes()


def scheme_named(name: str) -> Scheme:
    """One of the reference's, or of these."""
    return SCHEMES[name] if name in SCHEMES else EXPLICIT[name]
