"""Runs that go on by the steps of another scheme: from one step, one time or one share of each on.

With K steps of the declared scheme first, an interval between two samples is its as long as it ends
by step K, the other scheme's where it begins there or later, and of both where K lies within it. So
each run allows some K, and all runs together one, one time or one share.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.stepping.kept_run import LEAST, KeptRun, SchemeOf
from omegadot.diagnosis.wording.digits import limits
from omegadot.reference_impl.schemes import COMMON

LAST = 4  # intervals of a run, which the other scheme makes
MOST_LOOKED_AT = 4  # runs that these are of
SCENARIOS = 2  # at least, whose runs show both schemes
WHENS = 3  # a number of steps, a time, a share of the run
MOST_NAMED = 3  # schemes that are the same in all these runs
NEAR = 1e-9  # relative: a time that is a whole number of steps but for rounding


def switched(by: SchemeOf, runs: Sequence[KeptRun]) -> list[str]:
    """From which step, time or share on all runs are stepped by which other scheme."""
    failing = [run for run in runs if run.fails]
    if not any(_begins(run, by) for run in failing):
        return []
    last = [_last(run) for run in failing[:MOST_LOOKED_AT]]
    last = [run for run in last if not np.any(run.sound(by))]
    texts, names = set[str](), list[str]()
    for name in COMMON if last else ():
        other = SchemeOf(COMMON[name], by.coordinates)
        if name == by.scheme.name or by.coordinates not in other.scheme.coordinates:
            continue
        if all(np.all(run.sound_but_for_rounding(other)) for run in last):
            text = _when(by, other, runs)
            texts |= {text} if text is not None else set()
            names += [name] if text is not None else []
    if len(texts) != 1 or len(names) > MOST_NAMED or "" in texts:
        return []  # with another scheme it begins elsewhere, or with none at one step
    return [f"from {texts.pop()} on, steps are those of {' or '.join(names)}"]


def _begins(run: KeptRun, by: SchemeOf) -> bool:
    """Whether its first interval is the declared scheme's."""
    bounds = {channel: values[:1] for channel, values in run.bounds.items()}
    first = replace(run, times=run.times[:2], state=run.state[:2], bounds=bounds)
    return bool(np.all(first.sound_but_for_rounding(by)))


def _last(run: KeptRun) -> KeptRun:
    """Its last intervals alone."""
    bounds = {channel: values[-LAST:] for channel, values in run.bounds.items()}
    return replace(run, times=run.times[-LAST - 1 :], state=run.state[-LAST - 1 :], bounds=bounds)


def _when(by: SchemeOf, other: SchemeOf, runs: Sequence[KeptRun]) -> str | None:
    """The step, the time or the share of a run that all allow; None where none is.

    "" where more than one of these is, or too few runs show both schemes.
    """
    least, most = np.zeros(WHENS), np.full(WHENS, np.inf)
    shown = set[str]()
    for run in runs:
        known, shows = _allowed(run, by, other)
        if not len(known):
            return None
        shown |= {run.name} if shows else set()
        first, last = float(known[0]), float(known[-1])
        if known[-1] == run.sweep.sample_steps[len(run.times) - 1]:
            last = np.inf  # it may never change
        units = np.array([1.0, run.timestep, 100.0 / run.sweep.steps])
        # a time or a share lies in the step after which it is over, or is that step's end
        least = np.maximum(least, (first - np.array([0.0, 1.0, 1.0])) * units)
        most = np.minimum(most, last * units)
    open_ = least <= most * np.array([1.0, 1.0 - NEAR, 1.0 - NEAR])
    open_ &= (most < np.inf) & (most > 0.0)
    if not open_.any():
        return None
    if len(shown) < SCENARIOS or np.count_nonzero(open_) > 1:
        return ""
    if open_[0]:
        begins, ends = int(least[0]) + 1, int(most[0]) + 1
        return f"step {begins}" if begins == ends else f"a step between {begins} and {ends}"
    if open_[1]:
        return f"a time between {limits(max(0.0, least[1]), most[1], 's')}"
    return f"a share of each run between {limits(max(0.0, least[2]), most[2], '%')}"


def _allowed(run: KeptRun, by: SchemeOf, other: SchemeOf) -> tuple[NDArray[np.intp], bool]:
    """After how many of its steps the run may change; and whether it shows both schemes."""
    one, two = (run.sound_but_for_rounding(each) for each in (by, other))
    ends = run.sweep.sample_steps[: len(run.times)]
    begins, ends = ends[:-1], ends[1:]
    least = int(np.max(begins[~two] + 1, initial=0))
    most = int(np.min(ends[~one] - 1, initial=ends[-1]))
    found = [k for k in range(least, most + 1) if _makes(run, by, other, k)]
    first = np.count_nonzero(one & ~two & (ends <= most)) >= LEAST
    then = np.count_nonzero(two & ~one & (begins >= least)) >= LEAST
    return np.array(found, dtype=int), bool(first and then)


def _makes(run: KeptRun, by: SchemeOf, other: SchemeOf, count: int) -> bool:
    """Whether the interval in which so many steps end is made by both schemes, where one is."""
    every, place = run.sweep.every, count // run.sweep.every
    within = count - place * every
    if not within or place >= len(run.times) - 1:
        return True
    bounds = {channel: values[place : place + 1] for channel, values in run.bounds.items()}
    here = replace(
        run,
        times=run.times[place : place + 2],
        state=run.state[place : place + 2],
        bounds=bounds,
        sweep=replace(run.sweep, every=within),
    )
    middle = here.ends(by)
    rest = replace(here, sweep=replace(run.sweep, every=every - within))
    start = replace(
        rest,
        state=type(middle)(
            *(
                np.concatenate((a, b[1:]))
                for a, b in zip(vars(middle).values(), vars(here.state).values(), strict=True)
            )
        ),
    )
    return bool(np.all(here.reached(start.ends(other))))
