"""Where a run is sound and where it is not: sample to sample, and quantity by quantity.

The last resort, where no single cause explains a whole run: every sample is stepped on by the
declared scheme to the next, so that what is wrong at one place does not spoil the rest.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.match import only_where
from omegadot.diagnosis.reported_run import ReportedRun
from omegadot.gates.measured_run import CHANNELS

# One interval's rounding is within the bound of its end; its start is rounded, too.
SLACK = 2.0
ALONE = {
    "the attitude": ("orientation",),
    "omega": ("angular_velocity",),
    "the position": ("position",),
    "the linear velocity": ("linear_velocity",),
    "the linear velocity, with the position,": ("linear_velocity", "position"),
}


def sound_intervals(reported: ReportedRun) -> NDArray[np.bool_]:
    """(n - 1,): whether the declared scheme leads from each sample to the next."""
    numbers = reported.sweep.sample_steps
    count = int(np.count_nonzero(np.diff(numbers) == reported.sweep.every))
    ends = reported.stepped_on(reported.state[:count])
    then, bounds = reported.state[1 : count + 1], reported.bounds
    sound = np.ones(count, bool)
    for channel in CHANNELS:
        apart = reported.truth.yardstick.distance(channel, then, ends)
        sound &= apart <= SLACK * bounds[channel][1 : count + 1]
    return sound


def one_field(reported: ReportedRun) -> str:
    """All but one quantity are sound, and so they are stepped with the right one."""
    for text, names in ALONE.items():
        right = {name: getattr(reported.own, name) for name in names}
        if reported.agrees(replace(reported.state, **right), reported.own):
            own = right[names[0]]
            off = float(np.max(np.abs(getattr(reported.state, names[0]) - own)))
            part = off / float(np.max(np.abs(own)))
            return f"{text} alone is wrong in the run, by up to {part:.1e} of it"
    return ""


def intervals(reported: ReportedRun) -> str:
    """From which sample to which the steps are wrong."""
    sound = sound_intervals(reported)
    wrong = np.flatnonzero(~sound)
    if len(sound) < 3 or not len(wrong) or not sound.any():
        return ""
    time, first, last = reported.time, int(wrong[0]), int(wrong[-1])
    if len(wrong) == 1 and first == 0:
        return f"only the first steps are wrong: from t = {time[1]:.4g} s on, the run is sound"
    if len(wrong) <= 2 and last - first <= 1 and last + 1 < len(sound):
        pairs = (values[last] == values[last - 1] for values in vars(reported.state).values())
        twice = last > 0 and all(bool(np.all(pair)) for pair in pairs)
        what = "is the one before, reported twice" if twice else "alone does not belong to the run"
        return f"the sample at t = {time[last]:.4g} s {what}"
    if first > 0 and len(wrong) == len(sound) - first:
        return f"the run is sound until t = {time[first]:.4g} s, and every step after it is wrong"
    where = only_where(reported.state[: len(sound)], sound)
    return f"steps are wrong only where {where}" if where else ""
