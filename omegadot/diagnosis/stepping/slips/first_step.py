"""The first step of every run is by another scheme than all that follow.

From the first sample one step of that scheme, and then those of the run's own, lead to the second.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf, plain_names
from omegadot.diagnosis.wording.kinds import either
from omegadot.reference_impl.coordinates import canonical
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.schemes import COMMON
from omegadot.reference_impl.schemes.scheme import Scheme
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import State

SCENARIOS, ENOUGH = 3, 4  # that show it, and intervals of each run beside the first


def first_step_causes(by: SchemeOf, runs: Sequence[KeptRun]) -> list[str]:
    """The scheme of the first steps; none where a run has it not, or is wrong later."""
    with np.errstate(all="ignore"):
        short = [run.short for run in runs if len(run.times) > ENOUGH]
        sound = [
            run.sound(SchemeOf(by.scheme, canonical(run.system, by.coordinates))) for run in short
        ]
        wrong = [run for run, good in zip(short, sound, strict=True) if not good[0]]
        if len({run.name for run in wrong}) < SCENARIOS:
            return []
        if not all(np.all(good[1:]) for good in sound):
            return []
        others = [one for name, one in COMMON.items() if name != by.scheme.name]
        found = [one for one in others if all(_begins(run, by, one) for run in (*wrong, *short))]
        names = [one.name for one in found]
        own = by.scheme.name
        return either(
            [f"the first step of a run is by {one}, not by {own}" for one in plain_names(names)]
        )


def _begins(run: KeptRun, by: SchemeOf, first: Scheme) -> bool:
    """Whether the run's second sample is by one step of this scheme, and then its own."""
    coordinates = canonical(run.system, by.coordinates)
    motion, every = body_motion(run.system, coordinates), run.sweep.every
    ends = State(*(field[:1] for field in vars(run.state).values()))
    for scheme, count in ((first, 1), (by.scheme, every - 1)):
        if count:
            plan = (run.sweep.timestep, count, count, coordinates)
            ends = step_body(scheme, run.system, ends, *plan, motion)[1][-1]
    return bool(run.reached(ends, 1).all())
