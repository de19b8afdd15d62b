"""Basilisk's integrators, stepping and logging in native code.

A simulation's times are whole nanoseconds. A run whose step is a number of them is one call of
`SimModel.StepUntilStop`, with a recorder on the spacecraft's message. Any other is, for each step,
a call of `integrate`, which takes seconds, and of the hub's `modifyStates`, as in a simulation.
"""

from __future__ import annotations

from itertools import pairwise
from time import perf_counter
from typing import Any

import numpy as np

from omegadot.adapters.basilisk.hub import STATES
from omegadot.adapters.basilisk.model import BasiliskModel
from omegadot.reference_impl.system import Array

EPS = float(np.finfo(float).eps)
ROOT_OF_LARGEST = 2.0**512  # the least number whose square is not finite


def nanoseconds(timestep: float) -> int:
    """The step as a number of nanoseconds, 0 where it is none.

    Basilisk multiplies them by 1e-9, which is as near to the step as two roundings leave it.
    """
    count = round(timestep * 1e9)
    return count if abs(count * 1e-9 - timestep) <= 2 * EPS * timestep else 0


def run_simulation(
    basilisk: Any, model: BasiliskModel, step: int, kept: list[int]
) -> tuple[Array, float]:
    """Rows (n, 12) of sigma, omega, place and velocity of the origin, and the s of the steps.

    step: in ns.  kept: the numbers of the steps that are logged.
    """
    craft, (first, last) = model.craft, (kept[1], kept[-1])
    simulation, process = basilisk.SimModel(), basilisk.SysProcess("process")
    task = basilisk.SysModelTask(step)
    task.TaskName = "task"
    process.addNewTask(task)
    simulation.addNewProcess(process)
    recorder = craft.scStateOutMsg.recorder(first * step)
    task.AddNewObject(craft, 1)  # before the recorder, which logs what it wrote
    task.AddNewObject(recorder, 0)
    simulation.assignRemainingProcs()
    simulation.ResetSimulation()
    simulation.selfInitSimulation()
    simulation.resetInitSimulation()
    simulation.StepUntilStop(0, -1)  # a step of no length, and the first sample
    began = perf_counter()
    simulation.StepUntilStop(last * step, -1)
    seconds = perf_counter() - began
    columns = (recorder.sigma_BN, recorder.omega_BN_B, recorder.r_BN_N, recorder.v_BN_N)
    rows = np.hstack([np.reshape(column, (-1, 3)) for column in columns])
    if last % first:
        end = craft.scStateOutMsg.read()
        rows = np.vstack((rows, [*end.sigma_BN, *end.omega_BN_B, *end.r_BN_N, *end.v_BN_N]))
    return rows, seconds


def run_directly(model: BasiliskModel, timestep: float, kept: list[int]) -> tuple[Array, float]:
    """The same with a step in s, of any length."""
    model.reset()
    craft, hub, integrate = model.craft, model.craft.hub, model.craft.integrator.integrate
    logged = [craft.dynManager.getStateObject(name) for name in STATES]
    rows = [[own.getState() for own in logged]]
    began = perf_counter()
    for start, end in pairwise(kept):
        for step in range(start, end):
            integrate(step * timestep, timestep)
            hub.modifyStates((step + 1) * timestep)
        rows.append([own.getState() for own in logged])
    seconds = perf_counter() - began
    return np.reshape(rows, (len(kept), 12)), seconds


def is_finite(row: Array) -> bool:
    """Whether numbers are finite, and their squares."""
    return bool(np.all(np.abs(row) < ROOT_OF_LARGEST))
