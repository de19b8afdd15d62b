"""A load that acts for another time of a step, or by another part, in steps beyond some length."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.stepping.loads.acting import with_factors
from omegadot.diagnosis.stepping.loads.load_parts import (
    LOADS,
    LoadPart,
    leads,
    least_stated,
    load_factors,
    load_parts,
    looked_at,
    own_scheme,
)
from omegadot.diagnosis.wording.digits import factor, number

LEAST = 2  # different lengths of step on each side of a length beyond which another part acts
SAME = 1e-6  # relative, of numbers that are one
KNOWN = 1e-2  # to which a part must be known to count as one
RATES = range(2, 10001)  # 1/s, of which a limit may be one over
Found = Mapping[str, LoadPart]


@dataclass(frozen=True)
class _Law:
    """part: of a load that acts, by the length of a step in s. text: with {} for the load."""

    part: Callable[[float], float]
    text: str


def load_time_causes(by: SchemeOf, runs: Sequence[KeptRun]) -> list[str]:
    """The load that acts by another part in steps beyond a length, and how; none without any.

    It must make every run that fails, and those that do not.
    """
    with np.errstate(all="ignore"):
        failing, sound = looked_at(runs)
        names, found = list(LOADS), list[tuple[KeptRun, Found]]()
        for run in failing:
            found.append((run, parts := load_parts(run.short, by, names)))
            names = [name for name in names if name in parts and parts[name].fits]
            if not names:
                return []
        found += [(run, load_parts(run.short, by, names)) for run in sound]
        return least_stated(
            {
                name: f"in the steps, {text}"
                for name in names
                if (text := _law(name, found, by, runs))
            }
        )


def _law(
    name: str, found: Sequence[tuple[KeptRun, Found]], by: SchemeOf, runs: Sequence[KeptRun]
) -> str:
    """How a load acts in all runs; "" where by no law of the length of a step."""
    parts = [(run.timestep, one[name]) for run, one in found if name in one and one[name].shows]
    return next((law.text.format(name) for law in _laws(parts) if _makes(name, law, by, runs)), "")


def _laws(parts: Sequence[tuple[float, LoadPart]]) -> Iterator[_Law]:
    steps, part, known = np.array([(h, p.part, p.known_to) for h, p in parts]).reshape(-1, 3).T
    room = SAME * np.maximum(1.0, np.abs(part)) + known
    off = np.abs(part - 1.0) > room
    one = ~off & (known < KNOWN)
    if len(np.unique(steps[off])) < LEAST:
        return
    best = int(np.argmin(np.where(off, known * steps, np.inf)))
    time, share = float(part[best] * steps[best]), float(part[best])
    if time > 0.0 and np.all(np.abs(part * steps - time)[off] <= (room * steps)[off]):
        upto = f"{{}} acts for {_seconds(time)}"
        if np.all(steps[one] <= time * (1.0 + SAME)) and np.all(steps[off] > time):
            text = f"{upto} of each step where steps are longer than that"
            yield _Law(lambda h: min(1.0, time / h), text)
        elif np.all(steps[one] >= time * (1.0 - SAME)) and np.all(steps[off] < time):
            text = f"{upto} in each step where steps are shorter than that"
            yield _Law(lambda h: max(1.0, time / h), text)
        elif not one.any():
            yield _Law(lambda h: time / h, f"{upto} in each step, whatever its length")
    if np.any(np.abs(part - share)[off] > room[off]) or len(np.unique(steps[one])) < LEAST:
        return
    share = 0.0 if abs(share) <= room[best] else share
    acts = "{} does not act" if share == 0.0 else f"{{}} is scaled by {factor(share)}"
    least, most = float(np.min(steps[off])), float(np.max(steps[off]))
    if float(np.max(steps[one])) < least:
        text = f"of {number(least)} s and longer, and not of {number(np.max(steps[one]))} s"
        yield _Law(lambda h: share if h >= least else 1.0, f"{acts} in steps {text} and shorter")
    elif float(np.min(steps[one])) > most:
        text = f"of {number(most)} s and shorter, and not of {number(np.min(steps[one]))} s"
        yield _Law(lambda h: share if h <= most else 1.0, f"{acts} in steps {text} and longer")


def _seconds(time: float) -> str:
    """``0.0166667 s (1/60 s)``."""
    rate = round(1.0 / time)
    whole = rate in RATES and abs(rate * time - 1.0) <= SAME
    shown = number(float(f"{time:.7g}"))
    return f"{shown} s (1/{rate} s)" if whole and float(shown) != 1.0 / rate else f"{shown} s"


def _makes(name: str, law: _Law, by: SchemeOf, runs: Sequence[KeptRun]) -> bool:
    """Whether the law leads from each sample to the next, in every run in which it says a thing."""
    for run in sorted(runs, key=lambda run: (not run.fails, run.sweep.every)):
        part, own = law.part(run.timestep), own_scheme(run, by)
        if own is None:
            return False
        if run.fails or part != 1.0:
            motion = with_factors(run.system, own, load_factors([name], np.array([part])))
            if not np.all(leads(run, own, motion, 1)):
                return False
    return True
