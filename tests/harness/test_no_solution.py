"""Steps so long that an implicit scheme has no solution and raises: reported, and not judged.

What these tests catch: such a scheme accused; an engine excused that raises at steps short enough,
or at the finer ones as well, or whose scheme is known to have a solution.
"""

from __future__ import annotations

import numpy as np
import pytest

from omegadot.adapters.protocol import Trajectory
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.commands.faults.detect import Nameless, judge
from omegadot.commands.faults.prepared import Pool, Prepared
from omegadot.harness.arguments import case_of
from omegadot.harness.judging.no_solution import reason_without_a_solution
from omegadot.reference_impl.system import State
from omegadot.scenarios import scenario
from omegadot.workers.harness_end.process import Answer

NOTE = "not judged: at steps of 1.2 rad the engine raises ArithmeticError: no solution"


class Raising(ReferenceAdapter):
    """Raises where a step is between two lengths, in s."""

    def __init__(self, least: float, most: float) -> None:
        super().__init__()
        self.least, self.most = least, most

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        if self.least < timestep < self.most:
            raise ArithmeticError("no solution")
        return super().run(initial, integrator, timestep, steps, every)


def prepared(pool: Pool, radians: float) -> Prepared:
    """A sphere at 2 rad/s, the longest step of so many radians."""
    longest = radians / 2.0
    steps = [longest, longest / 2, longest / 4]
    sphere = scenario(
        name="fast-sphere",
        body={"mass": 1.0, "inertia": [[0.4, 0.0, 0.0], [0.0, 0.4, 0.0], [0.0, 0.0, 0.4]]},
        initial={"angular_velocity": [0.0, 0.0, 2.0]},
        run={"duration": 8 * longest, "timesteps": steps, "sample": longest},
    )
    return pool._solved(case_of(sphere, ()))


@pytest.mark.parametrize(
    ("radians", "least", "most", "accused"),
    [
        (1.2, 0.5, 1.0, False),
        (0.9, 0.4, 1.0, True),  # steps of which there is a solution
        (1.2, 0.2, 0.5, True),  # finer ones alone
        (1.2, 0.2, 1.0, True),  # finer ones as well
    ],
)
def test_a_step_without_a_solution(
    radians: float, least: float, most: float, accused: bool
) -> None:
    pool = Pool(0)
    case = prepared(pool, radians)
    engine = Raising(least, most)
    found = judge(pool, case, "own", Nameless(engine))
    assert found.accused is accused
    if not accused:
        assert {run.outcome for run in found.runs} == {"ok", "diverged"}
        assert all(run.reason.startswith(NOTE) for run in found.runs if run.outcome != "ok")
    assert judge(pool, case, "own", engine).accused  # its schemes are known


def test_an_engine_may_raise_where_its_scheme_overflows() -> None:
    pool = Pool(0)
    case = prepared(pool, 0.9)
    sweep, truth = case.case.sweeps[0], case.truth
    own = next(i for i in ReferenceAdapter().description.integrators if i.name == "lie-rk4")
    pool.step_companions(case, [own], [sweep])
    raised = [(sweep, Answer("raised", "FloatingPointError: overflow"))]
    assert reason_without_a_solution(truth, own, sweep, raised) == ""
    companion = truth.companion(own, sweep)
    assert companion is not None
    companion.state.angular_velocity[-1] = np.inf
    note = "not judged: the scheme itself blows up at so large a step, where the engine raises"
    found = reason_without_a_solution(truth, own, sweep, raised)
    assert found == f"{note} FloatingPointError: overflow"
