"""Turns below a limit that steps do not make, of any scheme."""

from __future__ import annotations

import numpy as np
import pytest
from test_over_runs import kept
from wrong_equations import CASES

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.over_runs import causes_over_runs
from omegadot.diagnosis.stepping.turns.short_turns import short_turns
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.schemes.scheme import CHANNELS
from omegadot.reference_impl.system import Array, System

LIMIT = 0.05  # rad


def named(limit: float, of_start: bool = False, every: int = 1) -> list[str]:
    """Of a scheme that the reference has not: a step of the attitude between two of omega."""

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        new = v + 0.5 * h * motion.acceleration(q, v)
        turn = h * float(np.linalg.norm((v if of_start else new)[-3:]))
        moved = h * new
        moved[-3:] *= turn > limit
        q = motion.retract(q, moved)
        return q, new + 0.5 * h * motion.acceleration(q, new)

    runs = [kept(one, step, h, every) for one in CASES for h in (0.05, 0.02, 0.005)]
    found = short_turns(runs)
    unknown = Integrator("own", None, dict.fromkeys(CHANNELS, 2))
    assert not found or causes_over_runs(unknown, runs) == found
    return found


@pytest.mark.parametrize(("of_start", "every"), [(True, 1), (False, 4), (True, 4)])
def test_the_limit_of_a_turn_is_named(of_start: bool, every: int) -> None:
    """Caught: "the attitude does not move", which longer steps contradict."""
    (text,) = named(LIMIT, of_start, every)
    low, high = (float(one) for one in text.split("between ")[1].split()[0:3:2])
    assert text.startswith("a step does not turn the body by less than a limit")
    assert low < LIMIT * 1.02
    assert high > LIMIT * 0.98
    assert high - low < 0.2 * LIMIT


def test_runs_whose_every_step_turns_show_none() -> None:
    assert named(0.0) == []
