"""Steps that are not taken, or taken twice, by their number in the runs of all scenarios."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from test_over_runs import CASES, euler, kept

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.kept_run import SchemeOf
from omegadot.diagnosis.stepping.over_runs import causes_over_runs
from omegadot.reference_impl.schemes import SCHEMES, Motion
from omegadot.reference_impl.schemes.scheme import CHANNELS
from omegadot.reference_impl.system import Array, System

EULER = "semi-implicit-euler"
Count = Callable[[int, float], int]
FINE, COARSE = ((0.02, 1), (0.009, 2)), ((0.02, 2), (0.009, 3))


def causes(count: Count, plans: tuple[tuple[float, int], ...], scheme: str | None) -> list[str]:
    """Of a step that is taken so many times, by its number from 1 on and the time."""

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        for _ in range(count(n + 1, n * h)):
            q, v = euler(motion, q, v, h, np.zeros(3))
        return q, v

    by = SchemeOf(SCHEMES[EULER], "com-world")
    runs = [kept(one, step, h, every) for one in CASES for h, every in plans]
    runs = [replace(run, fails=not bool(np.all(run.sound(by)))) for run in runs]
    return causes_over_runs(Integrator("own", scheme, dict.fromkeys(CHANNELS, 1)), runs)


@pytest.mark.parametrize("scheme", [EULER, None])
@pytest.mark.parametrize(
    ("count", "plans", "text"),
    [
        (lambda n, t: n % 8 != 0, FINE, "of every 8 steps of a run the last is not taken"),
        (lambda n, t: n % 8 != 0, COARSE, "of every 8 steps of a run the last is not taken"),
        (lambda n, t: n % 9 != 4, FINE, "of every 9 steps of a run one is not taken"),
        (lambda n, t: n != 17, FINE, "step 17 of a run is not taken, and the clock goes on"),
        (lambda n, t: n != 17, ((0.02, 3), (0.009, 3)), "step 16 to 18 of a run is not taken"),
        (lambda n, t: n % 20 != 0, ((0.02, 1),), "step 20 of a run is not taken"),
        (lambda n, t: 1 + (n % 8 == 0), FINE, "of every 8 steps of a run the last is taken twice"),
    ],
)
def test_steps_that_are_not_taken_are_named_by_number(
    count: Count, plans: tuple[tuple[float, int], ...], text: str, scheme: str | None
) -> None:
    """Caught: "every sample is the state one step before", from another time on in each run."""
    (found,) = causes(count, plans, scheme)
    assert found.startswith(text)


@pytest.mark.parametrize(
    "count",
    [
        lambda n, t: int(t < 0.2 or t > 0.22),  # by the time
        lambda n, t: n * n % 7 != 2,  # by no period
        lambda n, t: int(n != 11 or t < 0.15),  # one step, in runs of the longer steps alone
        lambda n, t: 1,
    ],
)
def test_steps_that_go_by_nothing_else_than_their_number_alone_are_named(count: Count) -> None:
    found = causes(count, FINE, EULER)
    assert not any("taken" in text for text in found)
