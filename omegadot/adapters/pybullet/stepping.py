"""PyBullet's steps. It has no call for several, so that each is one of `stepSimulation`."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from itertools import pairwise
from time import perf_counter
from typing import Any

import numpy as np

from omegadot.adapters.protocol import UnsupportedError
from omegadot.adapters.pybullet.joint import PyBulletJoint
from omegadot.adapters.pybullet.model import PyBulletModel
from omegadot.reference_impl.rotations import rotate_inverse
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


def torques_of(engine: Any, model: PyBulletModel) -> list[Callable[[], object]]:
    """What has to be called before each step, as PyBullet forgets torques after it.

    That in body axes is one of the joint where there is one, in the link's own axes: LINK_FRAME
    takes the axes of a link as they were a step before.
    """
    load, body, link, client = model.system.load, model.body, model.link, model.client
    own = rotate_inverse(model.frame, np.array(load.torque_body, float)).tolist()
    act, found = engine.applyExternalTorque, list[Callable[[], object]]()
    if load.torque_body.any() and model.strict and not model.free:
        drive, how = engine.setJointMotorControlMultiDof, engine.TORQUE_CONTROL
        found.append(partial(drive, body, link, how, force=own, physicsClientId=client))
    elif load.torque_body.any():
        found.append(partial(act, body, link, own, engine.LINK_FRAME, client))
    if load.torque_world.any():
        torque = np.array(load.torque_world, float).tolist()
        found.append(partial(act, body, link, torque, engine.WORLD_FRAME, client))
    return found


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
    step, client, torques = (
        engine.stepSimulation,
        joint.model.client,
        torques_of(engine, joint.model),
    )
    begin(engine, joint, start, h)
    rows = [joint.row()]
    began = perf_counter()
    for first, last in pairwise(kept):
        for _ in range(last - first):
            for act in torques:
                act()
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
