"""Steps of another length than the one requested, by a number of its own in every run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from omegadot.diagnosis.stepping.kept_run import CHANNELS, SLACK, KeptRun, SchemeOf
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.system import Array
from omegadot.written import written

MISSED, MOST_MISSED = 0.2, 2  # of the runs that fail: in some there may be other rounding
LEAST = 2  # runs that fail
DELTA, MOST_TRIES = 1e-6, 8  # a part of the step
ALIKE = 1e-3  # relative: parts that are one, which a run by itself shows
OTHER = 1e-6  # a part that is not seen in few steps, or by which two laws are one


def length_causes(by: SchemeOf, runs: Sequence[KeptRun]) -> list[str]:
    """What the steps' lengths are instead; none where they are right, or off by one part."""
    failing, sound = ([run for run in runs if run.fails is fails] for fails in (True, False))
    taken, missed = list[tuple[float, float]](), 0
    for number, run in enumerate(failing):
        part = _part(run.short, by)
        missed += part is None
        if missed > MOST_MISSED + MISSED * number:
            return []
        if part is not None:
            taken.append((run.sweep.timestep, part))
    steps, parts = np.array(taken).reshape(-1, 2).T
    other = np.abs(parts) > OTHER
    largest = float(np.max(np.abs(parts), initial=0.0))
    if np.count_nonzero(other) < LEAST or np.ptp(parts[other]) <= ALIKE * largest:
        return []
    most = float(np.max(steps[other]))
    right = [run.sweep.timestep for run in sound if run.sweep.timestep <= most]
    upto = steps <= most
    if _whole_rates(np.append(steps[upto], right), np.append(parts[upto], np.zeros(len(right)))):
        return ["the step is rounded to a whole number of steps in a second"]
    return [
        f"steps are up to {written(100 * largest, 2)} % longer or shorter than requested: by "
        "another part "
        "at each step size"
    ]


def _whole_rates(steps: Array, parts: Array) -> bool:
    """Whether every step is ``1 / round(1 / h)``."""
    with np.errstate(all="ignore"):
        due = 1.0 / np.round(1.0 / steps) / steps - 1.0
    return bool(np.all(np.abs(parts - due) <= OTHER))


def _part(run: KeptRun, by: SchemeOf) -> float | None:
    """By which part the steps of a run are too long, by Gauss-Newton; None where none makes it."""

    def apart(part: float) -> Array:
        taken = replace(run, sweep=replace(run.sweep, timestep=run.sweep.timestep * (1.0 + part)))
        found = run.apart(taken.ends(by))
        return np.stack([found[c] / run.bounds[c][:, None] for c in CHANNELS if _known(run, c)])

    found, before = 0.0, np.inf
    for _ in range(MOST_TRIES):
        here = apart(found)
        left = float(np.max(norm(here)))
        if left <= SLACK:
            return found
        if not left < before:
            return None
        before = left
        slope = (here - apart(found + DELTA)) / DELTA
        size = float(np.sum(slope * slope))
        found += float(np.sum(slope * here)) / size if size > 0.0 else np.nan
        if not -1.0 < found < 1.0:
            return None
    return None


def _known(run: KeptRun, channel: str) -> bool:
    """Whether a channel has bounds of its own: of a body at rest there are none."""
    return bool(np.all(run.bounds[channel] > 0.0))
