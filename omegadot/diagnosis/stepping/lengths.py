"""Steps of another length than the one requested, by a number of its own in every run."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from omegadot.diagnosis.stepping.fitted import SINGLE
from omegadot.diagnosis.stepping.kept_run import CHANNELS, SLACK, KeptRun, SchemeOf
from omegadot.diagnosis.wording.digits import number
from omegadot.diagnosis.wording.laws import law_of
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.system import Array
from omegadot.written import written

MISSED, MOST_MISSED = 0.2, 2  # of the runs that fail: in some there may be other rounding
LEAST = 2  # runs that fail
MOST_SOUND = 12  # runs in which a law must leave steps as they are
DELTA, MOST_TRIES = 1e-6, 8  # a part of the step
ALIKE = 1e-3  # relative: parts that are one, which a run by itself shows
OTHER = 1e-6  # a part that is not seen in few steps, or by which two laws are one
KNOWN = 0.1 * OTHER  # to which a part must be known where a law is looked for
MOST_UNITS = 64  # of which the shortest step is made, where steps are whole numbers of a unit
LEAST_OF_UNIT = 3  # different lengths that show a unit, and what is near to one by chance is not
SHOWS_UNIT = 1e3  # units at most: of longer steps anything is nearly a whole number of them
WHAT = "the length of a step"
WHOLE_RATE = "the step is rounded to a whole number of steps in a second"
ONE_AT_LEAST, LONGEST_OF_RATE = ", one at least", 2.0  # s: longer ones round to none a second
CLOCK = ", and the clock goes on as requested"
OTHER_LENGTHS: dict[str, Callable[[float], float]] = {
    SINGLE: lambda h: float(np.float32(h)),
    f"{WHOLE_RATE}{ONE_AT_LEAST}": lambda h: 1.0 / max(1.0, round(1.0 / h)),
}
WAYS = (("rounded", np.round), ("cut off", np.floor), ("rounded up", np.ceil))


@dataclass(frozen=True)
class _Taken:
    """By which part the steps of a run are too long, and to how much of a step that is known."""

    timestep: float
    part: float
    known_to: float


def length_causes(by: SchemeOf, runs: Sequence[KeptRun]) -> list[str]:
    """What the steps' lengths are instead; none where they are right, or off by one part."""
    failing, sound = ([run for run in runs if run.fails is fails] for fails in (True, False))
    made = [text for text, length in OTHER_LENGTHS.items() if _are(length, by, failing)]
    if len(made) == 1:
        # that there is one at least is seen in steps of which none makes a second
        bare = all(run.timestep < LONGEST_OF_RATE for run in failing)
        return [made[0].removesuffix(ONE_AT_LEAST) if bare else made[0]]
    taken, missed = list[_Taken](), 0
    for count, run in enumerate(sorted(failing, key=lambda run: run.timestep)):
        one = _taken(run.short, by)
        if one is None and taken:  # where steps have a longest length, most are far from it
            before = taken[-1].timestep * (1.0 + taken[-1].part)
            one = _taken(run.short, by, before / run.timestep - 1.0)
        missed += one is None
        if missed > MOST_MISSED + MISSED * count:
            return []
        taken += [one] if one is not None else []
    steps, parts = (np.array([getattr(one, x) for one in taken]) for x in ("timestep", "part"))
    other = np.abs(parts) > OTHER
    largest = float(np.max(np.abs(parts), initial=0.0))
    if np.count_nonzero(other) < LEAST or np.ptp(parts[other]) <= ALIKE * largest:
        return []
    most = float(np.max(steps[other]))
    right = [run.sweep.timestep for run in sound if run.sweep.timestep <= most]
    upto = steps <= most
    if _whole_rates(np.append(steps[upto], right), np.append(parts[upto], np.zeros(len(right)))):
        return [WHOLE_RATE]
    law = _law([*taken, *filter(None, (_taken(run.short, by) for run in _some(sound)))])
    return [
        f"{law}{CLOCK}"
        if law
        else f"steps are up to {written(100 * largest, 2)} % longer or shorter than requested: by "
        "another part "
        "at each step size"
    ]


def _are(length: Callable[[float], float], by: SchemeOf, failing: Sequence[KeptRun]) -> bool:
    """Whether the steps of all runs that fail have the length that is made of the requested one."""
    shown = 0
    for run in (one.short for one in failing):
        h = length(run.timestep)
        other = replace(run, sweep=replace(run.sweep, timestep=h))
        if not other.sound(by).all():
            return False
        shown += not run.sound(by).all()
    return shown >= LEAST


def _some(runs: Sequence[KeptRun]) -> list[KeptRun]:
    """Of different lengths of step, evenly."""
    by_length = list({run.sweep.timestep: run for run in runs}.values())
    by_length.sort(key=lambda run: run.sweep.timestep)
    places = np.linspace(0, len(by_length) - 1, min(len(by_length), MOST_SOUND)).astype(int)
    return [by_length[k] for k in places]


def _law(every: Sequence[_Taken]) -> str:
    """By which steps of all lengths are made out of those requested; "" without any."""
    known = [one for one in every if one.known_to <= KNOWN]
    if len(known) < LEAST:
        return ""
    due = np.array([one.timestep for one in known])
    acting = due * (1.0 + np.array([one.part for one in known]))
    pairs = [(due[k : k + 1], acting[k : k + 1]) for k in range(len(due))]
    return law_of(pairs, WHAT, "s") or _multiple(due, acting)


def _multiple(due: Array, acting: Array) -> str:
    """The unit of which every step is a whole number; "" where there is none.

    The longest that fits: with a part of it, not every length would come to its nearest number.
    """
    changed = np.unique(np.round(due[np.abs(acting - due) > OTHER * acting], 12))
    for count in range(1, MOST_UNITS + 1):
        unit = float(np.min(acting)) / count
        if np.count_nonzero(changed < SHOWS_UNIT * unit) < LEAST_OF_UNIT:
            return ""
        for way, whole in WAYS:
            if np.all(np.abs(np.maximum(whole(due / unit), 1.0) * unit - acting) <= OTHER * acting):
                return f"{WHAT} is {way} to a multiple of {number(unit)} s"
    return ""


def _whole_rates(steps: Array, parts: Array) -> bool:
    """Whether every step is ``1 / round(1 / h)``."""
    with np.errstate(all="ignore"):
        due = 1.0 / np.round(1.0 / steps) / steps - 1.0
    return bool(np.all(np.abs(parts - due) <= OTHER))


def _taken(run: KeptRun, by: SchemeOf, start: float = 0.0) -> _Taken | None:
    """By which part the steps of a run are too long, by Gauss-Newton; None where none makes it.

    It is known as well as the place at which most depends on it shows it.
    """

    def apart(part: float) -> Array:
        taken = replace(run, sweep=replace(run.sweep, timestep=run.sweep.timestep * (1.0 + part)))
        found = run.apart(taken.ends(by))
        return np.stack([found[c] / run.bounds[c][:, None] for c in CHANNELS if _known(run, c)])

    found, before = start, np.inf
    for _ in range(MOST_TRIES):
        here = apart(found)
        left = float(np.max(norm(here)))
        if not left < before:
            return None
        before = left
        slope = (here - apart(found + DELTA)) / DELTA
        steepest = float(np.max(norm(slope)))
        if left <= SLACK:
            known_to = 2.0 * SLACK / steepest if steepest > 0.0 else np.inf
            return _Taken(run.sweep.timestep, found, known_to)
        size = float(np.sum(slope * slope))
        found += float(np.sum(slope * here)) / size if size > 0.0 else np.nan
        if not -1.0 < found < 1.0:
            return None
    return None


def _known(run: KeptRun, channel: str) -> bool:
    """Whether a channel has bounds of its own: of a body at rest there are none."""
    return bool(np.all(run.bounds[channel] > 0.0))
