"""Where a run is sound and where it is not: sample to sample, and quantity by quantity.

The last resort, where no single cause explains a whole run: every sample is stepped on by the
declared scheme to the next, so that what is wrong at one place does not spoil the rest.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from omegadot.harness.diagnosis.only_where import only_where
from omegadot.harness.diagnosis.told_run import ToldRun, rows
from omegadot.harness.gates.course import CHANNELS

# One interval's rounding is within the bound of its end; its start is rounded, too.
SLACK = 2.0
ALONE = {
    "the attitude": ("orientation",),
    "omega": ("angular_velocity",),
    "the position": ("position",),
    "the linear velocity": ("linear_velocity",),
    "the linear velocity, with the position,": ("linear_velocity", "position"),
}


def causes(told: ToldRun) -> list[str]:
    """One sentence, or none."""
    for cause in (_intervals, _one_field):
        said = cause(told)
        if said:
            return [said]
    return []


def sound_intervals(told: ToldRun) -> NDArray[np.bool_]:
    """(n - 1,): whether the declared scheme leads from each sample to the next."""
    numbers = told.sweep.sample_steps
    count = int(np.count_nonzero(np.diff(numbers) == told.sweep.every))
    ends = told.stepped_on(rows(told.state, slice(0, count)))
    then, bounds = rows(told.state, slice(1, count + 1)), told.bounds
    sound = np.ones(count, bool)
    with np.errstate(all="ignore"):
        for channel in CHANNELS:
            apart = told.truth.yardstick.distance(channel, then, ends)
            sound &= apart <= SLACK * bounds[channel][1 : count + 1]
    return sound


def _one_field(told: ToldRun) -> str:
    """All but one quantity are sound, and so they are stepped with the right one."""
    for said, names in ALONE.items():
        right = {name: getattr(told.own, name) for name in names}
        if told.agrees(replace(told.state, **right), told.own):
            own = right[names[0]]
            off = float(np.max(np.abs(getattr(told.state, names[0]) - own)))
            part = off / float(np.max(np.abs(own)))
            return f"{said} alone is wrong in the run, by up to {part:.1e} of it"
    return ""


def _intervals(told: ToldRun) -> str:
    sound = sound_intervals(told)
    wrong = np.flatnonzero(~sound)
    if len(sound) < 3 or not len(wrong) or not sound.any():
        return ""
    time, first, last = told.time, int(wrong[0]), int(wrong[-1])
    if len(wrong) == 1 and first == 0:
        return f"only the first steps are wrong: from t = {time[1]:.4g} s on, the run is sound"
    if len(wrong) <= 2 and last - first <= 1 and last + 1 < len(sound):
        return _one_sample(told, last)
    if first > 0 and len(wrong) == len(sound) - first:
        return f"the run is sound until t = {time[first]:.4g} s, and every step after it is wrong"
    where = only_where(rows(told.state, slice(0, len(sound))), sound)
    return f"steps are wrong only where {where}" if where else ""


def _one_sample(told: ToldRun, sample: int) -> str:
    pairs = (values[sample] == values[sample - 1] for values in vars(told.state).values())
    if sample > 0 and all(bool(np.all(pair)) for pair in pairs):
        return f"the sample at t = {told.time[sample]:.4g} s is the one before, told twice"
    return f"the sample at t = {told.time[sample]:.4g} s alone does not belong to the run"
