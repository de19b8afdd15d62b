"""SAPIEN's steps. It has no call for several, so that each is one of `PhysxCpuSystem.step`."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from time import perf_counter

import numpy as np

from omegadot.adapters.sapien.model import SapienModel
from omegadot.reference_impl.system import Array, State

NO_FORCE = np.zeros(3)


def push_of(model: SapienModel) -> Callable[[], object] | None:
    """What has to be called before each step, as PhysX forgets torques after it. None: nothing.

    A torque is one in world axes: that in body axes is turned at the start of each step.
    """
    load, act, entity = model.system.load, model.actor.add_force_torque, model.entity
    constant = np.array(load.torque_world, float)
    own = np.array(load.torque_body, float).tolist()
    if not any(own):
        return (lambda: act(NO_FORCE, constant, "force")) if constant.any() else None
    x, y, z = constant.tolist()

    def push() -> None:
        a, b, c = turned(entity.get_pose().q.tolist(), own)
        act(NO_FORCE, (a + x, b + y, c + z), "force")

    return push


def turned(q: list[float], v: list[float]) -> tuple[float, float, float]:
    """``v + 2 r x (r x v + w v)`` of a unit quaternion (w, r), in bare numbers for speed."""
    (w, a, b, c), (x, y, z) = q, v
    i, j, k = b * z - c * y + w * x, c * x - a * z + w * y, a * y - b * x + w * z
    return (
        x + 2 * (b * k - c * j),
        y + 2 * (c * i - a * k),
        z + 2 * (a * j - b * i),
    )


def run(model: SapienModel, start: State, h: float, kept: list[int]) -> tuple[Array, float]:
    """Rows of the samples at these steps, and the s that the steps took.

    A run that is no longer finite has NaN in its later rows.
    """
    step, push = model.world.step, push_of(model)
    model.world.set_timestep(h)
    model.set_state(start)
    rows = np.full((len(kept), 13), np.nan)
    rows[0] = model.row()
    began = perf_counter()
    for at, (first, last) in enumerate(pairwise(kept), 1):
        for _ in range(last - first):
            if push is not None:
                push()
            step()
        rows[at] = model.row()
        if not np.all(np.isfinite(rows[at])):
            break
    return rows, perf_counter() - began
