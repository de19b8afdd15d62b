"""Where in a run it begins to be wrong: after a number of steps, after a time, or after a share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.reported.sample_causes import first_wrong
from omegadot.written import written

SOUND_UNTIL = "is sound until"
ALL_STEPS = ", whatever the step's length"
LEAST = 2  # runs, which distinguish a number of steps from a time


@dataclass(frozen=True)
class Onset:
    """Of one run, two numbers each: up to which sample it is sound, and by which it is wrong.

    steps: taken until then.  times: s.  shares: of the whole run's time.
    """

    steps: tuple[float, ...]
    times: tuple[float, ...]
    shares: tuple[float, ...]


def onset_of(reported: ReportedRun) -> Onset | None:
    """None of a run that is not sound up to one sample and wrong from there on.

    The first wrong sample of a run that is sound throughout lies beyond it.
    """
    first = first_wrong(reported)
    if first is None:
        return None
    numbers = np.append(reported.sweep.sample_steps.astype(float), np.inf)
    times = np.append(reported.time, np.inf)
    end = float(reported.sweep.times[-1])
    until = slice(first, first + 2)
    steps, seconds = (tuple(map(float, x[until])) for x in (numbers, times))
    return Onset(steps, seconds, tuple(x / end for x in seconds))


def onset_law(onsets: Sequence[Onset]) -> str:
    """The one of the three that is the same in all runs; "" where none or several are."""
    if len(onsets) < LEAST or all(np.isinf(one.steps[1]) for one in onsets):
        return ""
    laws = [
        _between(
            [one.steps for one in onsets],
            "for its first {} steps, and wrong by step {}" + ALL_STEPS,
        ),
        _between(
            [one.times for one in onsets], "until t = {} s, and wrong by t = {} s" + ALL_STEPS
        ),
        _between(
            [tuple(100.0 * x for x in one.shares) for one in onsets],
            "for the first {} % of its time, and wrong by {} % of it",
        ),
    ]
    known = [law for law in laws if law]
    return f"every run is sound {known[0]}" if len(known) == 1 else ""


def _between(ranges: Sequence[tuple[float, ...]], text: str) -> str:
    low, high = max(one[0] for one in ranges), min(one[1] for one in ranges)
    return text.format(written(low, 4), written(high, 4)) if low < high else ""
