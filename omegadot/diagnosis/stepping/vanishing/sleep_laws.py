"""A body that is put to sleep after some steps, or some time, below a limit: how many, of what."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.stepping.vanishing.rests import LEAST, MOST_NAMED, SLEEPS, UNITS
from omegadot.diagnosis.stepping.vanishing.sleep_chance import Law, odds_against
from omegadot.diagnosis.stepping.vanishing.sleep_pairs import OMEGA, PAIR, SPEED, law_of_two
from omegadot.diagnosis.stepping.vanishing.sleep_words import worded
from omegadot.diagnosis.stepping.vanishing.spells import (
    MOST_IN_A_ROW,
    NEAR,
    WAYS,
    Spell,
    awake,
    sizes,
)
from omegadot.diagnosis.wording.conditions import ODDS
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


@dataclass(frozen=True)
class Fits:
    """By how many steps in a row, or by which times in s, limits hold in all runs.

    found: (WAYS, Q, N), which do.  low and high: between what each limit is.
    """

    found: NDArray[np.bool_]
    low: Array
    high: Array
    times: Array | None = None

    @property
    def known(self) -> bool:
        """Whether the limit of each is between two numbers."""
        return bool(
            np.all(self.low[self.found] > 0.0) and np.all(np.isfinite(self.high[self.found]))
        )

    @property
    def tried(self) -> int:
        """How many laws the runs that fall asleep do not rule out by their length."""
        return int(np.count_nonzero(np.isfinite(self.low)))

    def ends(self) -> Iterator[Law]:
        """Of each quantity the laws of the fewest and the most steps that hold."""
        for way, k in zip(*np.nonzero(self.found.any(-1)), strict=True):
            places = np.flatnonzero(self.found[way, k])
            for n in {int(places[0]), int(places[-1])}:
                count, time = (n + 1, 0.0) if self.times is None else (0, float(self.times[n]))
                low, high = (float(part[way, k, n]) for part in (self.low, self.high))
                yield Law(int(k), low, high, int(way), count, time)


def law_of_sleep(every: Sequence[Sleeps]) -> str:
    """One law of all these integrators, by a number of steps in a row or by a time.

    "" where none holds, where many do, where chance makes one, and where one by a number and one by
    a time hold that say different things of steps of other lengths.
    """
    spells = [spell for one in every for spell in one.spells]
    others = [(run, one.by) for one in every for run in one.others]
    asleep = {spell.name for spell in spells}
    # of more steps in a row than are counted nothing is known where all runs have taken them
    if len(spells) < LEAST or len(asleep) < SCENARIOS or _fewest(spells) > MOST_IN_A_ROW:
        return ""
    with np.errstate(all="ignore"):
        counted, timed = _fits(spells, others, None), _fits(spells, others, _times(spells))
        apart = len({run.name for run, _ in others} - asleep)
        texts = _of_one(spells, counted, timed, apart)
        if not {OMEGA, SPEED} & texts.keys():  # with the right limit of one, any of the other holds
            texts[""] = _of_two(spells, others, apart)
    named = [text for text in texts.values() if text]
    several = "either " * (len(named) > 1)
    return f"{SLEEPS} where {several}{', or '.join(named)}" * (0 < len(named) <= MOST_NAMED)


def _of_one(spells: Sequence[Spell], counted: Fits, timed: Fits, apart: int) -> dict[str, str]:
    """By quantity, the law of a limit of this one alone."""
    fits = _the_one(spells, counted, timed)
    tried = ODDS * (counted.tried + timed.tried)
    if fits is None or all(odds_against(one, spells, apart) < tried for one in fits.ends()):
        return {}
    return {
        name: worded(name, fits.found[:, k], fits.low[:, k], fits.high[:, k], fits.times)
        for k, name in enumerate(UNITS)
        if fits.found[:, k].any()
    }


def _of_two(spells: Sequence[Spell], others: Sequence[tuple[KeptRun, SchemeOf]], apart: int) -> str:
    """The law of a limit of omega and one of the speed; of other runs the slowest are looked at."""
    slowest = sorted(others, key=lambda pair: float(np.min(np.max(sizes(pair[0])[PAIR], axis=0))))
    stepped = [awake(run, by) for run, by in slowest[:MOST_STEPPED]]
    known = [one for one in stepped if one is not None]
    return law_of_two(spells, known, _fewest(spells), _times(spells), apart)


def _fewest(spells: Sequence[Spell]) -> int:
    """The most states in a row that every run has had when it falls asleep."""
    return min(one.fell for one in spells) + WAYS - 1


def _the_one(spells: Sequence[Spell], counted: Fits, timed: Fits) -> Fits | None:
    """Those by numbers of steps or those by times, where the others say nothing else.

    A time no longer than the shortest step is one step. Of a time with more of these steps than
    are counted too little is known.
    """
    times, step = timed.times, min(one.timestep for one in spells)
    if times is None:
        return None
    other = timed.found.copy()
    other[:, counted.found[:, :, 0].any(0)] &= times > step * (1.0 + NEAR)
    if counted.found.any():
        return counted if counted.known and not other.any() else None
    unknown = bool(np.any(other & (times > MOST_IN_A_ROW * step)))
    return timed if other.any() and timed.known and not unknown else None


def _times(spells: Sequence[Spell]) -> Array:
    """s, for which a body may have to be below a limit: where the number of steps is another.

    Each second is such a time, and the others lie between two of these.
    """
    longest = min(one.timestep * (one.fell + WAYS - 1) for one in spells)
    steps = sorted({one.timestep for one in spells})
    every = [
        h * np.arange(1.0, min(longest / h * (1.0 + NEAR), MOST_IN_A_ROW) + 1.0) for h in steps
    ]
    ends = np.sort(np.append(np.concatenate(every), longest))
    ends = ends[np.append(True, np.diff(ends) > NEAR * ends[1:])]
    between = 0.5 * (ends + np.append(0.0, ends[:-1]))
    return np.ravel(np.stack((between, ends), axis=-1))


def _fits(
    spells: Sequence[Spell], others: Sequence[tuple[KeptRun, SchemeOf]], times: Array | None
) -> Fits:
    low, high = _bounds(spells, others, times)
    return Fits((low < high) & (high > 0.0), low, high, times)


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
