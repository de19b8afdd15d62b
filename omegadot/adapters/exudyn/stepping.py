"""Exudyn's solvers, stepping and logging in native code.

A run of fixed steps is one call of `SolveDynamic`, with a sensor on the node that keeps every k-th
step. An error-controlled run is a call from sample to sample, as steps end at the end of a call.
"""

from __future__ import annotations

from time import perf_counter
from typing import Any

import numpy as np

from omegadot.adapters.exudyn.integrators import SOLVES, Plan
from omegadot.adapters.exudyn.joint import place
from omegadot.adapters.exudyn.model import ExudynModel
from omegadot.adapters.protocol import Setup, UnsupportedError, mends
from omegadot.reference_impl.system import Array, State

SETTINGS = ("physicsInertia", "newton", "relativeTolerance")
SHORTEST = 1e-9  # of a sample's spacing: the least step of an error-controlled run
ROOT_OF_LARGEST = 2.0**512  # the least number whose square is not finite


def settings_of(exudyn: Any, plan: Plan, setup: Setup, accuracy: float | None = None) -> Any:
    """What all runs of an integrator have in common, at an accuracy or at Exudyn's own."""
    found = exudyn.SimulationSettings()
    found.solution.file.write = False
    own = found.timeIntegration
    own.solverType = getattr(exudyn.DynamicSolverType, plan.solver)
    own.adaptiveStep = own.automaticStepSize = not plan.fixed
    if mends(setup, "newton") and not plan.explicit:
        own.newton.relativeTolerance = own.newton.absoluteTolerance = SOLVES
    if accuracy:
        own.absoluteTolerance = own.relativeTolerance = accuracy
    if mends(setup, "relativeTolerance") and not plan.fixed:
        own.relativeTolerance = 0.0
    return found


def run_fixed(
    exudyn: Any, model: ExudynModel, settings: Any, start: State, h: float, kept: list[int]
) -> tuple[Array, float]:
    """Coordinates with their rates (n, k) at these steps, and the s that the steps took.

    A run that is no longer finite has NaN in its later rows.  Raises what Exudyn raises, and
    UnsupportedError where it takes no step.
    """
    steps, own = kept[-1], settings.timeIntegration
    own.numberOfSteps, own.endTime = steps, steps * h
    own.minimumStepSize = min(own.minimumStepSize, 0.5 * h)
    settings.solution.sensors.writePeriod = (kept[1] - kept[0]) * h
    place(exudyn, model, start)
    began = perf_counter()
    try:
        model.mbs.SolveDynamic(settings, storeSolver=False)
        failed = None
    except RuntimeError as error:
        failed = error
    seconds = perf_counter() - began
    times, logged = model.logged()
    if failed and len(times) == 1:
        raise UnsupportedError(
            f"Newton's iterations of Exudyn's {settings.timeIntegration.solverType.name} do not "
            f"converge in the first step of {h} s; take smaller steps"
        ) from failed
    if failed and is_finite(logged[-1]):
        raise failed
    rows = np.full((len(kept), logged.shape[1]), np.nan)
    # where a step is shorter than 1e-10 s, the tolerance of the sensor's clock, it keeps all steps
    numbers = np.rint(times / h).astype(int)
    at = np.searchsorted(kept, numbers).clip(max=len(kept) - 1)
    wanted = np.array(kept)[at] == numbers
    rows[at[wanted]] = logged[wanted]
    return rows, seconds


def run_by_accuracy(
    exudyn: Any, model: ExudynModel, settings: Any, start: State, times: Array
) -> tuple[Array, float]:
    """The same at these times in s, of which the first is 0."""
    own, data, mbs = settings.timeIntegration, model.mbs.systemData, model.mbs
    own.numberOfSteps = 1
    settings.solution.sensors.active = False
    place(exudyn, model, start)
    kind = exudyn.ConfigurationType.Initial
    rows = [np.hstack((data.GetODE2Coordinates(kind), data.GetODE2Coordinates_t(kind)))]
    began = perf_counter()
    for first, last in zip(times[:-1].tolist(), times[1:].tolist(), strict=True):
        own.startTime, own.endTime = first, last
        own.minimumStepSize = SHORTEST * (last - first)
        mbs.SolveDynamic(settings, updateInitialValues=True, storeSolver=False)
        rows.append(np.hstack((data.GetODE2Coordinates(), data.GetODE2Coordinates_t())))
        if not is_finite(rows[-1]):
            break
    seconds = perf_counter() - began
    found = np.full((len(times), len(rows[0])), np.nan)
    found[: len(rows)] = rows
    return found, seconds


def is_finite(row: Array) -> bool:
    """Whether coordinates are finite, and their squares."""
    return bool(np.all(np.abs(row) < ROOT_OF_LARGEST))
