"""An equation that engines solve to less than rounding: what it leaves is the scheme's, no more."""

from __future__ import annotations

import numpy as np
import pytest
from in_process import builtin, judged, truth_of

from omegadot.adapters.protocol import Integrator, Trajectory
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.gates.bounds.scales import norm
from omegadot.gates.steps.scheme import OPENED
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.schemes import SCHEMES, Motion, Scheme
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Array, State

CASE = builtin("full-tensor", 0.02, 0.01, 0.005)


class Unsolved(ReferenceAdapter):
    """A scheme whose steps leave a rest of the momentum, in parts of it, and of a torque in N m."""

    def __init__(self, scheme: str, part: float, torque: float) -> None:
        super().__init__()
        self.scheme, self.part, self.torque = SCHEMES[scheme], part, torque

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        inertia = moving_inertia(self.system)

        def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
            q, v = self.scheme.step(motion, q, v, h)
            rest = self.part * norm(apply(inertia, v[..., -3:])) + self.torque * timestep
            more = np.zeros_like(v)
            more[..., -3:] = np.linalg.solve(inertia, rest * np.array([0.0, 0.0, 1.0]))
            return q, v + more

        own = Scheme("own", "", step, self.scheme.orders)
        return Trajectory(*step_body(own, self.system, initial, timestep, steps, every))


def rows(scheme: str, part: float, torque: float = 0.0) -> list[tuple[str, bool]]:
    integrator = Integrator(scheme, scheme, dict(SCHEMES[scheme].orders))
    truth = truth_of(CASE, (scheme,))
    runs = judged(CASE, truth, integrator, Unsolved(scheme, part, torque))
    found = [row for run in runs for row in run.rows if row.metric == "match"]
    return [(row.verdict, OPENED in row.note) for row in found]


def test_what_the_scheme_leaves_unsolved_passes_and_is_said() -> None:
    """Caught: MuJoCo 3.8 accused of the rest at which its Newton iteration ends."""
    name = "frozen-torque-midpoint"
    assert rows(name, 2e-13) == [("pass", True)] * 3
    assert rows(name, 0.0, 1e-13)[0][0] == "pass"
    assert rows(name, 0.0) == [("pass", False)] * 3


@pytest.mark.parametrize(
    ("name", "part"), [("frozen-torque-midpoint", 3e-11), ("implicit-midpoint", 2e-12)]
)
def test_a_larger_rest_or_one_of_a_solved_scheme_fails(name: str, part: float) -> None:
    assert rows(name, part) == [("fail", False)] * 3
