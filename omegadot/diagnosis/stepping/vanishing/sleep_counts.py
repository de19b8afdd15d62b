"""A body that is put to sleep after some steps, or some time, below a limit: how many, of what."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import comb

import numpy as np
from numpy.typing import NDArray

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf, scheme_of
from omegadot.diagnosis.stepping.vanishing.rests import LEAST, MOST_NAMED, SLEEPS, UNITS, between
from omegadot.diagnosis.stepping.vanishing.spells import (
    MOST_IN_A_ROW,
    NEAR,
    Spell,
    awake,
    rests_from,
    sizes,
    slept,
)
from omegadot.diagnosis.wording.conditions import ODDS
from omegadot.diagnosis.wording.digits import limits
from omegadot.reference_impl.system import Array

SCENARIOS = 2  # at least, that show it
MOST_STEPPED = 64  # runs that do not fall asleep, of the slowest


@dataclass(frozen=True, eq=False)
class Sleeps:
    """statement: after what a body is put to sleep.  names: of the scenarios that this explains.

    spells: of the runs that fall asleep.  others: the runs that do not.  by: how they are stepped.
    """

    statement: str
    names: frozenset[str]
    spells: tuple[Spell, ...]
    others: tuple[KeptRun, ...]
    by: SchemeOf


def sleeping_runs(integrator: Integrator, kept: Sequence[KeptRun]) -> Sleeps | None:
    """The law by which the runs of one integrator fall asleep; None without any."""
    with np.errstate(all="ignore"):
        resting = [run for run in kept if run.fails and rests_from(run)]
        by = scheme_of(integrator, kept) if len(resting) >= LEAST else None
        if by is None:
            return None
        found = [(run, slept(run, by)) for run in resting]
        spells = tuple(spell for _, spell in found if spell is not None)
        explained = {id(run) for run, spell in found if spell is not None}
        left = {run.name for run in kept if run.fails and id(run) not in explained}
        names = frozenset({spell.name for spell in spells} - left)
        others = tuple(run for run in kept if not rests_from(run))
        one = Sleeps("", names, spells, others, by)
        text = law_of_sleep([one]) if names else ""
    return Sleeps(text, names, spells, others, by) if text else None


def law_of_sleep(every: Sequence[Sleeps]) -> str:
    """One law of all these integrators; "" where none holds, where many do, or chance makes one."""
    spells = [spell for one in every for spell in one.spells]
    others = [(run, one.by) for one in every for run in one.others]
    asleep = {spell.name for spell in spells}
    apart = {run.name for run, _ in others} - asleep
    ways = comb(len(asleep) + len(apart), len(asleep))
    if len(spells) < LEAST or len(asleep) < SCENARIOS or ways < ODDS * len(UNITS):
        return ""
    for times in (None, _times(spells)):
        with np.errstate(all="ignore"):
            low, high = _bounds(spells, others, times)
        fits = (low > 0.0) & (low < high) & (high < np.inf)
        found = [
            _worded(name, fits[:, k], low[:, k], high[:, k], times)
            for k, name in enumerate(UNITS)
            if fits[:, k].any()
        ]
        if found:
            several = "either " * (len(found) > 1)
            text = f"{SLEEPS} where {several}{', or '.join(found)}"
            return text * (len(found) <= MOST_NAMED)
    return ""


def _times(spells: Sequence[Spell]) -> Array:
    """s, up to which a body may have to be below a limit: where the number of steps is another."""
    longest = min(one.longest for one in spells)
    steps = sorted({one.timestep for one in spells})
    every = [
        h * np.arange(1.0, min(longest / h * (1.0 + NEAR), MOST_IN_A_ROW) + 1.0) for h in steps
    ]
    return np.unique(np.concatenate(every))


def _bounds(
    spells: Sequence[Spell],
    others: Sequence[tuple[KeptRun, SchemeOf]],
    times: Array | None,
) -> tuple[Array, Array]:
    """Low and high of all, by how many steps in a row, or by how long.

    Of the runs that do not fall asleep the slowest are stepped again.
    """

    def ends(one: Spell) -> tuple[Array, Array]:
        return (one.low, one.high) if times is None else one.below_for(times)

    low, high = ends(spells[0])
    for one in spells[1:]:
        more, less = ends(one)
        low, high = np.maximum(low, more), np.minimum(high, less)
    if not others or not np.any(low < high):
        return low, high
    least, looked_at = np.stack([np.min(sizes(run), axis=-1) for run, _ in others]), set[int]()
    for k in range(len(UNITS)):
        for place in map(int, np.argsort(least[:, k])):
            open_ = high[:, k][low[:, k] < high[:, k]]
            if not len(open_) or least[place, k] >= np.max(open_) or len(looked_at) >= MOST_STEPPED:
                break
            if place not in looked_at:
                looked_at.add(place)
                spell = awake(*others[place])
                high = high if spell is None else np.minimum(high, ends(spell)[1])
    return low, high


def _worded(
    name: str, fits: NDArray[np.bool_], low: Array, high: Array, times: Array | None
) -> str:
    """Of one quantity: fits, low and high (WAYS, N), or (1, T) of these times in s."""
    way = int(np.argmax(fits.any(-1)))
    fit = np.flatnonzero(fits[way])
    limit = between(float(np.min(low[way, fit])), float(np.max(high[way, fit])), UNITS[name])
    below = f"{name} is below a limit between {limit}"
    if times is None:
        return below + _in_a_row(fit + 1, bool(way))
    before = np.append(0.0, times)[fit[0]]
    return f"{below} for a time between {limits(float(before), float(times[fit[-1]]), 's')}"


def _in_a_row(counts: NDArray[np.intp], with_given: bool) -> str:
    least, most = int(counts[0]), int(counts[-1])
    if most == 1:
        return ""
    what = "states in a row, the given one among them" if with_given else "steps in a row"
    if most == MOST_IN_A_ROW:
        return f" in {least} or more {what}"
    return f" in {least if least == most else f'{least} to {most}'} {what}"
