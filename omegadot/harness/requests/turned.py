"""The same run in a world of other axes: a long step may err by the coordinates that it takes.

It is requested where a step of more than an eighth of a turn has an error that no order explains.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from omegadot.gates.case import Case
from omegadot.harness.drive import Driver
from omegadot.harness.outcome import EngineCase
from omegadot.reference_impl.rotations import conjugate, quaternion_product, rotate
from omegadot.reference_impl.system import Array, State

# Axes of the world become each other's, or none of them stays near another: unit quaternions.
TURNS = (np.array([0.5, 0.5, 0.5, 0.5]), np.array([0.8, 0.4, -0.2, 0.4]))


def axes_may_decide(case: Case, found: EngineCase) -> bool:
    """Whether any run of the engine may err by the coordinates that it takes, not yet seen."""
    return any(run.by_axes for run in found.runs)


def request_turned(driver: Driver, case: Case, found: EngineCase) -> None:
    """Each run that the axes may decide in turned worlds, its states turned back, into the result.

    The motion is the same but for the turn: ``q' = t q``, ``p' = t p``, ``g' = t g`` and so on.
    """
    for turn, other in _turned_cases(case):
        for run in (run for run in found.runs if run.by_axes):
            answer = driver.run(other, run.integrator.name, run.sweep)
            if answer.ok and len(answer.result["time"]) == len(run.sweep.times):
                state = turned(State(**answer.result["state"]), conjugate(turn))
                key = run.integrator.name, run.sweep.knob
                found.result.turned.setdefault(key, []).append(state)


def _turned_cases(case: Case) -> Iterator[tuple[Array, Case]]:
    system, load = case.system, case.system.load
    for number, turn in enumerate(TURNS):
        loads = {
            "gravity": rotate(turn, load.gravity),
            "torque_world": rotate(turn, load.torque_world),
        }
        scenario = case.scenario.model_copy(update={"name": f"{case.name}-turned-{number}"})
        other = replace(system, load=replace(load, **loads))
        initial = turned(case.initial, turn)
        yield turn, replace(case, scenario=scenario, system=other, initial=initial)


def turned(states: State, turn: Array) -> State:
    """States in a world that is turned by a unit quaternion; omega is in body axes and stays."""
    return State(
        quaternion_product(turn, states.orientation),
        states.angular_velocity,
        rotate(turn, states.position),
        rotate(turn, states.linear_velocity),
    )
