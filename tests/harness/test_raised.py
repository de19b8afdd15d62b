"""Runs that raise an error: excused where the scheme blows up, by what finer steps show.

What these tests catch: a sound scheme accused that raises where it blows up, at every step of a
sweep even; an engine excused that raises while its motion is bounded, that is wrong at the finer
steps, or that raises at fine steps or at all of them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from omegadot.adapters.protocol import Trajectory
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.commands.faults.detect import Nameless, judge
from omegadot.commands.faults.prepared import Pool, Prepared
from omegadot.gates.case import Case
from omegadot.harness.judging.judged_run import is_finite
from omegadot.harness.random_cases import random_case
from omegadot.reference_impl.system import State, System

EULER = "semi-implicit-euler"
BLOWS_UP = "not judged: it blows up at so large a step, where the engine raises"
Raises = Callable[[float, State], bool]


class Raising(ReferenceAdapter):
    """Raises where a run of this step and these samples is one of which it does."""

    def __init__(self, raises: Raises, torque: float = 1.0) -> None:
        super().__init__()
        self.raises, self.torque = raises, torque
        self.stepper = ReferenceAdapter()

    def load(self, system: System) -> None:
        super().load(system)
        load = replace(system.load, torque_body=self.torque * system.load.torque_body)
        self.stepper.load(replace(system, load=load))

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        with np.errstate(all="ignore"):
            found = self.stepper.run(initial, integrator, timestep, steps, every)
        if self.raises(timestep, found.state):
            raise ArithmeticError("math domain error")
        return found


def blows_up(timestep: float, state: State) -> bool:
    return not is_finite(state)


def prepared() -> tuple[Pool, Prepared]:
    """A thin body, on which semi-implicit Euler blows up at 12, 6 and 3 s, and not at 1.5 s."""
    pool = Pool(0)
    case: Case = random_case(21, 111)
    return pool, pool._solved(case)


def judged(raises: Raises, torque: float = 1.0) -> tuple[bool, list[str], set[str]]:
    """Whether the engine is accused; the outcomes of its runs, and their reasons."""
    pool, case = prepared()
    engine = Nameless(Raising(raises, torque))
    own = tuple(one for one in engine.description.integrators if one.name == EULER)
    found = judge(pool, case, "own", engine, own)
    return found.accused, [run.outcome for run in found.runs], {run.reason for run in found.runs}


def test_a_scheme_that_raises_where_it_blows_up_is_judged_by_finer_steps() -> None:
    accused, outcomes, reasons = judged(blows_up)
    assert not accused
    assert outcomes == ["diverged"] * 3
    assert reasons == {f"{BLOWS_UP} ArithmeticError: math domain error"}


@pytest.mark.parametrize(
    ("raises", "torque"),
    [
        (lambda h, state: len(state.position) > 5 and h > 2.0, 1.0),  # nothing has blown up yet
        (lambda h, state: h > 2.0, 1.0),  # not one sample is given
        (blows_up, 2.0),  # wrong at finer steps
    ],
)
def test_an_engine_that_raises_is_accused(raises: Raises, torque: float) -> None:
    accused, outcomes, reasons = judged(raises, torque)
    assert accused
    assert "raised" in outcomes
    assert not any("every step" in reason for reason in reasons)


def test_an_engine_that_raises_at_every_step_is_accused_and_the_shortest_is_named() -> None:
    accused, outcomes, reasons = judged(lambda h, state: True)
    assert accused
    assert outcomes == ["raised"] * 3
    assert any("and so it does at every step down to" in reason for reason in reasons), reasons


def test_an_engine_that_raises_at_fine_steps_alone_is_accused() -> None:
    accused, outcomes, _ = judged(lambda h, state: not is_finite(state) or h < 4.0)
    assert accused
    assert "raised" in outcomes
