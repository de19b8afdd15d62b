"""Steps of a Runge-Kutta method in lanes, in each of which single stages are changed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from omegadot.diagnosis.stepping.explicit_schemes import TABLEAUS
from omegadot.diagnosis.stepping.on_quaternion import Rows
from omegadot.diagnosis.stepping.slips.slips import CLASSIC
from omegadot.diagnosis.stepping.slips.stage_changes import Change
from omegadot.diagnosis.stepping.slips.staged_equation import Stages
from omegadot.reference_impl.coordinates import from_coordinates
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.system import Array, State, System

KUTTA = (CLASSIC, (1 / 6, 1 / 3, 1 / 3, 1 / 6))
QUATERNION, SERIES, CLOSED, STRAIGHT = "quaternion", "series", "closed", "straight"
# By scheme its rows and weights, and how the attitude moves in the stages.
STAGED: dict[str, tuple[Rows, Sequence[float], str]] = {
    "rk4-quaternion": (*KUTTA, QUATERNION),
    "lie-rk4": (*KUTTA, SERIES),
    "munthe-kaas-rk4": (*KUTTA, CLOSED),
    "lie-rk4-naive": (*KUTTA, STRAIGHT),
    **{
        f"{name} {how}": (rows, weights, way)
        for name, (order, rows, weights) in TABLEAUS.items()
        for how, way in (("on the quaternion", QUATERNION), ("with the exponential", STRAIGHT))
        if order > 1 and (order < 3 or way == QUATERNION)
    },
}


def staged_run(
    system: System,
    name: str,
    changes: Sequence[Change],
    start: tuple[Array, Array],
    plan: tuple[float, int, int],
) -> State:
    """(changes, count, ...): states of a run by a scheme of STAGED, with one change a lane.

    start: q and v, (k,) and (n,).  plan: the step in s, steps between samples, and their count.
    """
    timestep, every, count = plan
    q, v = (np.broadcast_to(x, (len(changes), len(x))).copy() for x in start)
    stages, motion = Stages(system, changes), body_motion(system)
    places, velocities = list[Array](), list[Array]()
    with np.errstate(all="ignore"):
        for _ in range(count):
            for _ in range(every):
                stages.begin()
                q, v = _step(name, stages, motion, q, v, timestep)
            places.append(q)
            velocities.append(v)
        ends = np.stack(places, axis=1), np.stack(velocities, axis=1)
        return from_coordinates(system, *ends, "com-world")


def _step(
    name: str, stages: Stages, motion: Motion, q: Array, v: Array, h: float
) -> tuple[Array, Array]:
    rows, weights, way = STAGED[name]
    rates, pushes = list[Array](), list[Array]()
    at_u: Array = np.zeros_like(q if way == QUATERNION else v)
    at_v = v
    for row in rows:
        if row:
            at_u, at_v = h * _sum(row, rates), v + h * _sum(row, pushes)
        rate, at_q, size = _moved(motion, way, q, at_u, at_v)
        rate, push = stages.rates(rate, at_q, at_v, size)
        rates.append(rate)
        pushes.append(push)
    u, v = h * _sum(weights, rates), v + h * _sum(weights, pushes)
    return motion.normalize(q + u) if way == QUATERNION else motion.retract(q, u), v


def _sum(weights: Sequence[float], slopes: Sequence[Array]) -> Array:
    return np.asarray(sum(a * slope for a, slope in zip(weights, slopes, strict=True) if a))


def _moved(motion: Motion, way: str, q: Array, u: Array, v: Array) -> tuple[Array, Array, int]:
    """The rate of a stage's place, the unit place, and how many of the rate are the attitude's."""
    if way == QUATERNION:
        return motion.coordinate_rate(q + u, v), motion.normalize(q + u), 4
    of = {SERIES: motion.rate_to_second_order, CLOSED: motion.rate}
    return of[way](u, v) if way in of else v, motion.retract(q, u), 3
