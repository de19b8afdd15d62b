"""A load that acts in the first steps of a run alone, or begins to act later: up to which step.

Each interval of a run is stepped with all of the load, and with what is left of it. Where the last
that needs all of it comes before the first that needs the rest, the step between them lies there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.stepping.loads.acting import with_factors
from omegadot.diagnosis.stepping.loads.load_parts import (
    LoadPart,
    leads,
    load_factors,
    load_parts,
    own_scheme,
)
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.system import Array

LEAST = 3  # intervals that need what is left of a load
CHANGED = 0.01  # of a load, at least
MOST_STEPS = 160  # in question for the last one
MOST_EVALUATIONS = 4  # of omega-dot in a step, after some of which a load may stop


@dataclass(frozen=True)
class Spell:
    """A load of which all acts at first and another part later; or where not stops, the reverse."""

    name: str
    part: float
    stops: bool


@dataclass(frozen=True)
class Turn:
    """Of a run: after how many steps the load may change, from low to high; inf where unknown.

    within: whether it does so in the course of the step after these.
    """

    run: KeptRun
    low: float
    high: float
    within: bool = False


def spells_of(run: KeptRun, by: SchemeOf) -> list[Spell]:
    """What may explain one run: a part of a load after its first wrong interval, or until its last.

    None of a run of too few wrong intervals.
    """
    own = own_scheme(run, by)
    if own is None:
        return []
    wrong = np.flatnonzero(~run.sound(own))
    if len(wrong) < LEAST:
        return []
    found = list[Spell]()
    for stops in (True, False):
        rest = _intervals(run, wrong[0] + 1, len(run.lengths)) if stops else None
        rest = rest or _intervals(run, 0, wrong[-1])
        parts = load_parts(rest, by) if len(rest.lengths) >= LEAST - 1 else {}
        found += [Spell(name, _part(p), stops) for name, p in parts.items() if _is_another(p)]
    return found


def _is_another(one: LoadPart) -> bool:
    return one.fits and one.shows and abs(one.part - 1.0) > CHANGED


def _part(one: LoadPart) -> float:
    """In six digits, where it is not known to be another."""
    short = float(f"{one.part:.6g}") if abs(one.part) > one.known_to else 0.0
    return short if abs(short - one.part) <= one.known_to else one.part


def _intervals(run: KeptRun, first: int, end: int) -> KeptRun:
    samples = slice(first, end + 1)
    bounds = {channel: values[first:end] for channel, values in run.bounds.items()}
    return replace(run, times=run.times[samples], state=run.state[samples], bounds=bounds)


def turn_of(run: KeptRun, by: SchemeOf, spell: Spell) -> Turn | None:
    """After which steps of a run the load changes; None where that does not make the run."""
    own = own_scheme(run, by)
    if own is None:
        return None
    factors = load_factors([spell.name] * 2, np.array([1.0, spell.part]))
    motion = with_factors(run.system, own, factors)
    before, after = leads(run, own, motion, 2)[:: 1 if spell.stops else -1]
    every, count = run.sweep.every, len(run.lengths)
    # the last interval that needs what acts before, and the first that needs what acts after
    last = int(np.flatnonzero(~after)[-1]) if not np.all(after) else -1
    first = int(np.argmin(before)) if not np.all(before) else count
    if last > first:
        return None
    low, high = max(0, last * every), first * every + every - 1 if first < count else np.inf
    if last < 0 and first == count:
        return Turn(run, 0, np.inf)  # which shows nothing
    if high - low > MOST_STEPS:
        return Turn(run, low, high)
    return _exactly(run, own, spell, (last, first), np.arange(low, int(high) + 1.0))


def _exactly(
    run: KeptRun, own: SchemeOf, spell: Spell, between: tuple[int, int], numbers: Array
) -> Turn | None:
    """After which of these numbers of steps the load changes. between: intervals, as `turn_of`."""
    every, (last, first) = run.sweep.every, between
    for evaluations in range(MOST_EVALUATIONS):
        good = np.zeros(len(numbers), bool)
        for k in range(max(last, 0), min(first, len(run.lengths) - 1) + 1):
            here = (numbers >= k * every) & (numbers < (k + 1) * every)
            if np.any(here):
                lanes = numbers[here] - k * every
                scheme, motion = _switched(run, own, spell, lanes, evaluations)
                good[here] = leads(_intervals(run, k, k + 1), scheme, motion, len(lanes))[:, 0]
                # at its beginning it changes in none, and all after it need what acts after
                good[here] &= (lanes > 0) | (evaluations > 0) | (k > last)
        good &= numbers <= (first * every + every - 1)
        if np.any(good):
            fits = numbers[good]
            return Turn(run, float(fits[0]), float(fits[-1]), evaluations > 0)
    return None


def _switched(
    run: KeptRun, own: SchemeOf, spell: Spell, numbers: Array, evaluations: int
) -> tuple[SchemeOf, Motion]:
    """In each lane the load changes after so many steps, and evaluations of the one after them."""
    lanes = [spell.name] * len(numbers)
    factors = load_factors(lanes, np.ones(len(lanes)))
    plain = with_factors(run.system, own, factors)
    taken, evaluated = 0, 0

    def acceleration(q: Array, v: Array) -> Array:
        nonlocal evaluated
        before = (taken < numbers) | ((taken == numbers) & (evaluated < evaluations))
        factors.update(load_factors(lanes, np.where(before == spell.stops, 1.0, spell.part)))
        evaluated += 1
        return plain.acceleration(q, v)

    def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
        nonlocal taken, evaluated
        found = own.scheme.step(motion, q, v, h)
        taken, evaluated = taken + 1, 0
        return found

    switched = replace(own, scheme=replace(own.scheme, step=step))
    return switched, replace(plain, acceleration=acceleration)
