"""Steps so long that a variational scheme's equation has no root: reported, and not judged.

What these tests catch: such a scheme accused; a cap on omega or on the turn that passes for one; an
omega that is turned while the attitude is not.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from omegadot.adapters.protocol import Trajectory
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.commands.faults.detect import Judgement, Nameless, judge
from omegadot.commands.faults.prepared import Pool, Prepared
from omegadot.reference_impl.rotations import quaternion_product, turn_in_body
from omegadot.reference_impl.system import Array, State
from omegadot.scenarios.random_traits import BLOCK, drawn


@pytest.fixture(scope="module")
def pool() -> Pool:
    return Pool(2)


@pytest.fixture(scope="module")
def sphere(pool: Pool) -> Prepared:
    """The one that turns by more than a radian in its longest step."""
    found = [n for n in range(BLOCK) if drawn(2, n).steady]
    return next(p for p in map(pool.prepare, found) if len(p.case.sweeps) == 5)


class LongSteps(ReferenceAdapter):
    """Steps of more than a radian end as `wrong` makes of them."""

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        found = super().run(initial, integrator, timestep, steps, every)
        rate = float(np.linalg.norm(initial.angular_velocity))
        if rate * timestep <= 1.0:
            return found
        return replace(found, state=self.wrong(found.state, timestep, found.time))

    def wrong(self, state: State, timestep: float, time: Any) -> State:
        """Omega goes from axis to axis and the attitude back: a variational scheme's momentum."""
        turned = quaternion_product(state.orientation, np.array([0.5, -0.5, -0.5, -0.5]))
        turned[0] = state.orientation[0]
        return replace(state, orientation=turned, angular_velocity=shifted(state))


def shifted(state: State) -> Array:
    """Omega with its components moved on by one, but at the start: a third of a turn."""
    omega = state.angular_velocity.copy()
    omega[1:] = np.roll(omega[1:], 1, axis=-1)
    return omega


class OmegaTurned(LongSteps):
    """Omega goes from axis to axis, and the attitude takes no notice."""

    def wrong(self, state: State, timestep: float, time: Any) -> State:
        return replace(state, angular_velocity=shifted(state))


class OmegaHeld(LongSteps):
    """Omega is held to one radian a step."""

    def wrong(self, state: State, timestep: float, time: Any) -> State:
        omega = state.angular_velocity.copy()
        omega[1:] *= 1.0 / (timestep * np.linalg.norm(omega[0]))
        return replace(state, angular_velocity=omega)


class TurnHeld(LongSteps):
    """The attitude turns by half of pi in a step."""

    def wrong(self, state: State, timestep: float, time: Any) -> State:
        omega = state.angular_velocity[0]
        turns = (time / timestep)[:, None] * 0.5 * np.pi * omega / np.linalg.norm(omega)
        start = np.broadcast_to(state.orientation[0], state.orientation.shape)
        return replace(state, orientation=turn_in_body(start, turns, 1.0))


def judged(pool: Pool, sphere: Prepared, engine: ReferenceAdapter) -> Judgement:
    return judge(pool, sphere, "own", Nameless(engine))


def test_another_root_is_not_judged(pool: Pool, sphere: Prepared) -> None:
    found = judged(pool, sphere, LongSteps())
    assert not found.accused
    assert "diverged" in {run.outcome for run in found.runs}


@pytest.mark.parametrize("engine", [OmegaHeld, OmegaTurned, TurnHeld])
def test_caps_are_no_roots(engine: type[LongSteps], pool: Pool, sphere: Prepared) -> None:
    assert judged(pool, sphere, engine()).failed


def test_a_known_scheme_is_held_to_its_steps(pool: Pool, sphere: Prepared) -> None:
    assert judge(pool, sphere, "own", LongSteps()).failed
