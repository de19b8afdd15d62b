"""Long steps whose errors no order explains: those of coordinates are none of the motion."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from in_process import builtin, declared, truth_of

from omegadot.adapters.protocol import Trajectory
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.gates.errors.coordinates import NOTE
from omegadot.harness.drive import CaseResult
from omegadot.harness.in_process import driver_of
from omegadot.harness.judging.judged_run import JudgedRun
from omegadot.harness.judging.runs import judge_case
from omegadot.harness.outcome import EngineCase
from omegadot.harness.requests.turned import TURNS, axes_may_decide, request_turned, turned
from omegadot.reference_impl.rotations import conjugate, rotate, turn_in_body
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import stack, step_body
from omegadot.reference_impl.system import State

STEPS = tuple(0.25 * 0.5**k for k in range(5))
EPS = float(np.finfo(float).eps)
OFF = np.array([0.2, -0.1, 0.3])  # rad, by which a wrong step turns the body


class Wrong(ReferenceAdapter):
    """Runge-Kutta in quaternions, but for steps that are wrong."""

    def wrong(self, before: State, turn: float) -> bool:
        raise NotImplementedError

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        states = [initial]
        for _ in range(steps):
            now = states[-1]
            end = step_body(SCHEMES["rk4-quaternion"], self.system, now, timestep, 1, 1)[1][-1]
            turn = timestep * float(np.linalg.norm(now.angular_velocity))
            if self.wrong(now, turn):
                q = turn_in_body(end.orientation, OFF, 1.0)
                end = State(q, end.angular_velocity, end.position, end.linear_velocity)
            states.append(end)
        kept = list(range(0, steps + 1, every))
        kept += [steps] * (kept[-1] != steps)
        return Trajectory(timestep * np.array(kept), stack([states[k] for k in kept]))


class NearAPole(Wrong):
    """Angles that are singular where the body's z axis is along the world's x axis."""

    def wrong(self, before: State, turn: float) -> bool:
        z = rotate(before.orientation, np.array([0.0, 0.0, 1.0]))
        return turn > 0.8 and bool(abs(z[0]) > 0.7)


class BeyondATurn(Wrong):
    """A series that is too short where a step turns the body by more than 0.8 rad."""

    def wrong(self, before: State, turn: float) -> bool:
        return turn > 0.8


def judged(adapter: Wrong, turns: bool) -> list[JudgedRun]:
    """turns: whether the axes of the world are turned where they can decide."""
    case = builtin("offset-com", *STEPS)
    truth, how = truth_of(case, ()), declared("own", None, 4)
    result = CaseResult((how,))
    driver: Any = driver_of("toy", adapter, (how,))
    for sweep in case.sweeps:
        result.runs["own", sweep.timestep] = driver.run(case, "own", sweep)
    runs = judge_case(truth, case, result, {})
    if turns:
        found = EngineCase(driver.engine, result, [], runs)
        assert axes_may_decide(case, found)
        request_turned(driver, case, found)
        runs = judge_case(truth, case, result, {})
    return runs


@pytest.mark.parametrize(("engine", "of_axes"), [(NearAPole, True), (BeyondATurn, False)])
def test_a_long_step_that_errs_by_its_coordinates_is_not_judged(
    engine: type[Wrong], of_axes: bool
) -> None:
    """Caught: an engine in three angles, called wrong near their singularity; and a limit of a
    turn, which is the same whatever axes the world has, excused as such.
    """
    before, after = (judged(engine(), turns) for turns in (False, True))
    assert [run.by_axes for run in before] == [True] + [False] * (len(STEPS) - 1)
    assert [run.fails for run in before] == [True] + [False] * (len(STEPS) - 1)
    assert after[0].fails is not of_axes
    assert any(row.note == NOTE for row in after[0].rows) is of_axes


def test_a_turned_world_is_turned_back() -> None:
    case = builtin("offset-com")
    for turn in TURNS:
        assert abs(np.linalg.norm(turn) - 1.0) < 4 * EPS
        there = turned(case.initial, turn)
        back = turned(there, conjugate(turn))
        for one, other in zip(vars(back).values(), vars(case.initial).values(), strict=True):
            assert np.max(np.abs(one - other)) <= 8 * EPS * max(1.0, np.max(np.abs(other)))
        assert np.allclose(there.angular_velocity, case.initial.angular_velocity)
