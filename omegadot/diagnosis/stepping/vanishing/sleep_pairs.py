"""A body that is put to sleep below a limit of omega and one of its speed, both at once.

With limits L and M, a body falls asleep in the first step after N steps in a row of which
``max |omega| < L`` and ``max |v| < M``. So the largest of these maxima over all runs that fall
asleep are below the limits, and no earlier N steps of any run are below both: of those that are
below the one, the least of the other is above its limit.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from math import comb, prod

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.stepping.vanishing.rests import UNITS, between
from omegadot.diagnosis.stepping.vanishing.sleep_words import worded
from omegadot.diagnosis.stepping.vanishing.spells import MOST_IN_A_ROW, NEAR, WAYS, Spell
from omegadot.diagnosis.wording.conditions import ODDS
from omegadot.reference_impl.system import Array

OMEGA, SPEED = "|omega|", "its speed"
PAIR = [[*UNITS].index(name) for name in (OMEGA, SPEED)]


@dataclass(frozen=True)
class Pairs:
    """By how many steps in a row, or by which times in s, two limits hold at once in all runs.

    found: (WAYS, N).  low and high: (WAYS, 2, N), between what the two limits are.
    """

    found: NDArray[np.bool_]
    low: Array
    high: Array
    times: Array | None = None


def law_of_two(
    spells: Sequence[Spell], awake: Sequence[Spell], counts: int, times: Array, apart: int
) -> str:
    """The law as text, by a number of steps or by a time; "" where none or both hold.

    spells: of the runs that fall asleep.  awake: of those that do not.  counts: the most steps in a
    row.  times: (T,) s.  apart: scenarios that do not fall asleep.
    """
    numbers = np.arange(1, counts + 1)
    counted = _pairs(spells, awake, np.tile(numbers, (len(spells) + len(awake), 1)), None, apart)
    each = np.stack([one.numbers_of(times) for one in (*spells, *awake)])
    timed = _pairs(spells, awake, each, times, apart)
    step = min(one.timestep for one in spells)
    longer = timed.found & (times > step * (1.0 + NEAR))
    if counted.found.any() and longer.any():
        return ""
    one = counted if counted.found.any() else timed
    if not one.found.any():
        return ""
    fits = one.found
    least, most = (np.where(fits, part[:, 1], np.nan) for part in (one.low, one.high))
    speed = between(float(np.nanmin(least)), float(np.nanmax(most)), UNITS[SPEED])
    more = f" and {SPEED} is below one between {speed}"
    return worded(OMEGA, fits, one.low[:, 0], one.high[:, 0], one.times, more)


def _pairs(
    spells: Sequence[Spell],
    awake: Sequence[Spell],
    numbers: NDArray[np.intp],
    times: Array | None,
    apart: int,
) -> Pairs:
    """numbers: (runs, N) steps in a row of each run, those that fall asleep first."""
    count = numbers.shape[1]
    found = np.zeros((WAYS, count), dtype=bool)
    low, high = np.full((2, WAYS, 2, count), np.nan)
    for way in range(WAYS):
        of_run = [_windows(one, way) for one in (*spells, *awake)]
        for n in range(count):
            windows = [at(int(k)) for at, k in zip(of_run, numbers[:, n], strict=True)]
            ends = _ends(spells, numbers[:, n], windows, way)
            if ends is None:
                continue
            low[way, :, n], high[way, :, n] = ends
            odds = _odds(spells, numbers[:, n], windows, ends[1], way, apart)
            found[way, n] = odds >= ODDS * WAYS * count
    return Pairs(found, low, high, times)


def _windows(spell: Spell, way: int) -> Callable[[int], Array]:
    values = spell.values[PAIR, 1 - way :]

    @cache
    def of(number: int) -> Array:
        """(2, n): the largest of so many in a row, by where they begin; of too many none."""
        if min(values.shape[1], MOST_IN_A_ROW) < number:
            return np.empty((2, 0))
        rows = np.lib.stride_tricks.sliding_window_view(values, number, axis=-1)
        return np.asarray(np.max(rows, axis=-1))

    return of


def _ends(
    spells: Sequence[Spell], numbers: NDArray[np.intp], windows: Sequence[Array], way: int
) -> tuple[Array, Array] | None:
    """Low and high (2,) of the two limits; None where no two hold in all runs."""
    low, before = np.zeros(2), list[Array]()
    for one, number, most in zip(spells, numbers, windows, strict=False):
        last = one.fell - int(number) + way
        if last < 0:
            return None
        if number > MOST_IN_A_ROW:
            continue
        first = max(0, last - one.early)
        low = np.maximum(low, np.min(most[:, first : last + 1], axis=-1))
        before.append(most[:, :first])
    earlier = np.concatenate([*before, *windows[len(spells) :]], axis=-1)
    high = np.array(
        [np.min(earlier[k, earlier[1 - k] <= low[1 - k]], initial=np.inf) for k in range(2)]
    )
    known = np.all((low > 0.0) & (low < high) & np.isfinite(high))
    return (low, high) if known else None


def _odds(
    spells: Sequence[Spell],
    numbers: NDArray[np.intp],
    windows: Sequence[Array],
    high: Array,
    way: int,
    apart: int,
) -> float:
    """How many laws chance would have to be given for one like this; two runs give the limits."""
    shares = dict[str, float]()
    for one, number, most in zip(spells, numbers, windows, strict=False):
        last = one.fell - int(number) + way
        among = int(np.count_nonzero(np.all(most[:, : last + 1] < high[:, None], axis=0)))
        share = min(1.0, (among + one.early) / one.fell) if number <= MOST_IN_A_ROW else 1.0
        shares[one.name] = min(share, shares.get(one.name, 1.0))
    rarest = sorted(shares.values())[:2]
    return comb(len(shares) + apart, apart) * prod(rarest) / prod(shares.values())
