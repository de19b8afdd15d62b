"""Steps that are taken in equal substeps, by one run and by all; and silence."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from test_over_runs import causes
from test_short_steps import own_run

from omegadot.diagnosis.stepping.loads.whole_substeps import substepped, substeps_of_run
from omegadot.reference_impl.schemes import SCHEMES, Motion
from omegadot.reference_impl.system import Array, System

EULER = "semi-implicit-euler"


@pytest.mark.parametrize(("count", "word"), [(2, "two"), (5, "five")])
def test_equal_substeps_are_named(count: int, word: str) -> None:
    """Caught: an engine with substeps that declares whole steps: "attitude is off"."""
    text = f"each step is taken in {word} equal substeps of {EULER}"
    inner = substepped(SCHEMES[EULER], count)

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        return inner.step(motion, q, v, h)

    assert causes(step) == [text]
    run = own_run("full-tensor").until(40)
    assert substeps_of_run(replace(run, state=run.stepped(inner))) == [text]


def test_whole_steps_and_uneven_ones_have_no_substeps() -> None:
    run = own_run("full-tensor").until(20)
    assert substeps_of_run(run) == []
    longer = run.stepped(timestep=(1.0 + 1e-6) * run.sweep.timestep)
    assert substeps_of_run(replace(run, state=longer)) == []
    still = replace(run.own, angular_velocity=np.zeros_like(run.own.angular_velocity))
    assert substeps_of_run(replace(run, state=still)) == []
