"""Rapier's steps. It has no call for several, so that each is one of `PhysicsWorld.step`."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from time import perf_counter

import numpy as np

from omegadot.adapters.rapier3d.integrators import ITERATIONS
from omegadot.adapters.rapier3d.model import RapierModel, quaternion_of
from omegadot.reference_impl.arithmetic.components import rotated
from omegadot.reference_impl.system import Array, State

SHORT = 2.0**-100  # s


def push_of(model: RapierModel) -> Callable[[], object] | None:
    """Set the torque that acts in world axes; what has to be called before each step, if anything.

    A torque acts until it is reset. One in body axes is turned at the start of each step.
    """
    load, rigid = model.system.load, model.rigid
    constant = np.array(load.torque_world, float).tolist()
    own = np.array(load.torque_body, float).tolist()
    if not any(own):
        if any(constant):
            rigid.add_torque(tuple(constant))
        return None
    x, y, z = constant

    def push() -> None:
        a, b, c = rotated(quaternion_of(rigid.rotation), own)
        rigid.reset_torques()
        rigid.add_torque((a + x, b + y, c + z))

    return push


def run(model: RapierModel, start: State, h: float, kept: list[int]) -> tuple[Array, float]:
    """Rows of the samples at these steps, and the s that the steps took.

    A run that is no longer finite has NaN in its later rows: Rapier puts such a body back to where
    it was, and disables it.
    """
    parameters, step = model.world.integration_parameters, model.world.step
    parameters.num_solver_iterations, parameters.dt = ITERATIONS, h
    model.set_state(start)
    push = push_of(model)
    rows = np.full((len(kept), 13), np.nan)
    rows[0] = model.row()
    began = perf_counter()
    for at, (first, last) in enumerate(pairwise(kept), 1):
        for _ in range(last - first):
            if push is not None:
                push()
            step()
        row = model.row()
        if not (model.rigid.is_enabled and np.all(np.isfinite(row))):
            break
        rows[at] = row
    return rows, perf_counter() - began


def omega_dot(model: RapierModel, state: State) -> Array:
    """omega-dot (3,) in world axes of a pivoted body: `Multibody.generalized_acceleration`.

    It is that at the start of a step, which is so short that no number changes in it.
    """
    parameters = model.world.integration_parameters
    parameters.num_solver_iterations, parameters.dt = 1, SHORT
    model.set_state(state)
    push = push_of(model)
    if push is not None:
        push()
    model.world.step()
    assert model.multibody is not None
    return np.array(model.multibody.generalized_acceleration(), float)
