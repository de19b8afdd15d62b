"""All causes in the stepping of one run that stepping it again may show."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.stepping.fitted import damped, longer
from omegadot.diagnosis.stepping.limits import asleep, clipped, held, speed, still, turn_held
from omegadot.diagnosis.stepping.loads.whole_substeps import substeps_of_run
from omegadot.diagnosis.stepping.other_equations import other_equations
from omegadot.diagnosis.stepping.slips.other_schemes import (
    explicit_schemes,
    other_ends,
    other_schemes,
    slips,
)
from omegadot.gates.bounds.scales import norm
from omegadot.harness.judging.judged_run import is_finite

MOST_STEPS = 5000  # causes are tried by stepping again, and a step takes about 0.1 ms
LEAST_SAMPLES = 4  # of fewer many mistakes make the same
STEADY = 1e-6  # rad: the axis of a steady spin turns by less


def stepping_causes(reported: ReportedRun, equations: bool) -> Iterator[str]:
    """Every one that makes this run; a scheme that is a guess is not wrong by itself.

    equations: whether the equation that is stepped may be another than the right one.
    """
    if not is_steppable(reported):
        return
    yield from filter(None, (asleep(reported), still(reported)))
    others = other_schemes(reported) if reported.is_declared else []
    yield from others
    yield from substeps_of_run(reported)
    yield from other_ends(reported)
    yield from filter(None, (turn_held(reported),))
    slipped = slips(reported)
    yield from slipped
    if reported.is_declared and not others and not slipped:  # a slip may make the same steps
        yield from explicit_schemes(reported)
    with_number = (longer, damped, clipped, held, speed)
    yield from filter(None, (cause(reported) for cause in with_number))
    yield from other_equations(reported) if equations else ()


def is_steppable(reported: ReportedRun) -> bool:
    """Whether a run is whole and short enough to be stepped again."""
    whole = len(reported.time) == len(reported.sweep.times)
    return whole and reported.sweep.steps <= MOST_STEPS and is_finite(reported.state)


def is_decisive(reported: ReportedRun) -> bool:
    """Whether a run has enough in it to decide between causes: a steady spin is one of most."""
    w = reported.own.angular_velocity
    with np.errstate(all="ignore"):
        axis = w / norm(w)[:, None]
    turned = norm(np.nan_to_num(axis - axis[0]))
    return len(w) >= LEAST_SAMPLES and bool(np.max(turned) > STEADY)
