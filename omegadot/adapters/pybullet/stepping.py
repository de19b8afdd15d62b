"""PyBullet's steps. It has no call for several, so that each is one of `stepSimulation`."""

from __future__ import annotations

import math
from itertools import pairwise
from time import perf_counter
from typing import Any

import numpy as np

from omegadot.adapters.protocol import UnsupportedError
from omegadot.adapters.pybullet.joint import PyBulletJoint
from omegadot.reference_impl.system import Array, State

# rad. Beyond, an attitude turns by this much in a step and omega does not know of it.
MOST_TURN = 0.25 * math.pi
# From a sample to the next omega may become larger than at both. By turning alone it grows by the
# root of the ratio of the moments at most; as much again is granted to torques.
MARGIN = 2.0
ROOT_OF_LARGEST = 2.0**512  # the least number whose square is not finite


def begin(engine: Any, joint: PyBulletJoint, start: State, h: float) -> None:
    """Put the world at the start of a run with steps of h s."""
    model = joint.model
    engine.setTimeStep(h, model.client)
    if model.kind == "maximal" and model.strict:
        # A pose that is set leaves the inertia in world axes as it was, until a step is taken.
        still = np.zeros(3)
        engine.setGravity(0.0, 0.0, 0.0, model.client)
        joint.set_state(State(start.orientation, still, start.position, still))
        engine.stepSimulation(model.client)
    engine.setGravity(*np.array(model.system.load.gravity, float).tolist(), model.client)
    joint.set_state(start)


def run(
    engine: Any, joint: PyBulletJoint, start: State, h: float, kept: list[int]
) -> tuple[Array, float]:
    """Rows of the samples at these steps, and the s that the steps took.

    A run that is no longer finite has NaN in its later rows.  Raises UnsupportedError where a step
    turns further than PyBullet turns a body. Every step is looked at only where that is near: a
    look costs as much as a step.
    """
    rows, seconds = _steps(engine, joint, start, h, kept, looking=False)
    if joint.model.strict and _may_be_cut(joint, rows, h):
        _steps(engine, joint, start, h, kept, looking=True)
    return rows, seconds


def _steps(
    engine: Any, joint: PyBulletJoint, start: State, h: float, kept: list[int], *, looking: bool
) -> tuple[Array, float]:
    model, step, act = joint.model, engine.stepSimulation, engine.applyExternalTorque
    body, link, client, torques = model.body, model.link, model.client, model.torques()
    begin(engine, joint, start, h)
    rows = [joint.row()]
    began = perf_counter()
    for first, last in pairwise(kept):
        for _ in range(last - first):
            for torque, axes in torques:  # PyBullet forgets them after each step
                act(body, link, torque, axes, client)
            step(client)
            if looking:
                refuse_long(joint.row(), h)
        rows.append(joint.row())
        if not is_finite(rows[-1]):
            break
    seconds = perf_counter() - began
    found = np.full((len(kept), len(rows[0])), np.nan)
    found[: len(rows)] = rows
    return found, seconds


def _may_be_cut(joint: PyBulletJoint, rows: Array, h: float) -> bool:
    """Whether a step between samples may have turned by ``MOST_TURN``."""
    moments = joint.model.moments
    with np.errstate(over="ignore", invalid="ignore"):
        fastest = h * np.linalg.norm(rows[:, -3:], axis=1)
        reach = MARGIN * np.sqrt(moments.max() / moments.min()) * fastest
    return not bool(np.all(reach < MOST_TURN))


def refuse_long(row: tuple[float, ...], h: float) -> None:
    """Raise UnsupportedError where the step before turned by ``MOST_TURN``, up to rounding."""
    if h * math.hypot(*row[-3:]) >= MOST_TURN * (1 - 1e-12):
        raise UnsupportedError(
            "PyBullet turns a body by less than omega does beyond 45 degrees in a step; take "
            "smaller steps"
        )


def is_finite(row: Any) -> bool:
    """Whether numbers are finite, and their squares."""
    return bool(np.all(np.abs(row) < ROOT_OF_LARGEST))
