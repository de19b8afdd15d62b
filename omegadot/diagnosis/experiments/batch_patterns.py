"""Which states of a batch a fault shows at, by the size of the batch and their places in it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.experiments.observed import Flags

ALONE = "a state is requested by itself"
TOGETHER = "that are requested together"
LANES = range(2, 33)  # of batches that are worked through so many states at a time
MOST_PLACES = 8  # of these, of which one alone may be wrong
Rule = Callable[[NDArray[np.intp], int], "Flags | bool"]  # of places (n,) among n


@dataclass(frozen=True)
class Pattern:
    """text: as a condition.  rule: whether it holds at places of a batch."""

    text: str
    rule: Rule

    def wrong(self, size: int) -> Flags:
        """(size,): of a batch of so many states."""
        found = self.rule(np.arange(size), size)
        return np.broadcast_to(np.asarray(found, dtype=bool), (size,))


def patterns_of(seen: Mapping[int, Flags]) -> list[Pattern]:
    """Those of the plainest kind that make all that is seen, by size; none where none does."""
    for tier in (_by_size, _by_multiples, _by_place, _by_lanes):
        found = [one for one in tier(seen) if _makes(one, seen)]
        if found:
            return found
    return []


def _makes(one: Pattern, seen: Mapping[int, Flags]) -> bool:
    return all(np.array_equal(one.wrong(size), wrong) for size, wrong in seen.items())


def _by_size(seen: Mapping[int, Flags]) -> Iterator[Pattern]:
    """All states of a batch, or none, by a limit."""
    wrong = [n for n, flags in seen.items() if np.all(flags)]
    right = [n for n, flags in seen.items() if not np.any(flags)]
    if not wrong or not right:
        return
    low, high, least = min(wrong), max(wrong), max(right)
    if least < low:
        many = "several states" if least == 1 else f"more than {least} states"
        yield Pattern(f"{many} are requested together", lambda k, n: n > least)
    elif high < min(right):
        few = f"{high} states or fewer are requested together" if high > 1 else ALONE
        yield Pattern(few, lambda k, n: n <= high)
    else:
        many = f"{low}" if low == high else f"{low} to {high}"
        yield Pattern(f"{many} states are requested together", lambda k, n: low <= n <= high)


def _by_multiples(seen: Mapping[int, Flags]) -> Iterator[Pattern]:
    for lanes in LANES:
        yield from _of_multiples(lanes)


def _of_multiples(lanes: int) -> Iterator[Pattern]:
    some = "an even number of" if lanes == 2 else f"a multiple of {lanes}"
    none = "an odd number of" if lanes == 2 else f"no multiple of {lanes}"
    yield Pattern(f"{some} states are requested together", lambda k, n: n % lanes == 0)
    yield Pattern(f"{none} states are requested together", lambda k, n: n % lanes != 0)


def _by_place(seen: Mapping[int, Flags]) -> Iterator[Pattern]:
    """The first so many, the last so many, or all but these."""
    flags = seen[max(seen)]
    for count in (np.flatnonzero(np.diff(flags.astype(int))) + 1).tolist():
        yield from _of_first(count)
        yield from _of_last(len(flags) - count)
    for which, place in (("first", 0), ("last", -1)):
        yield from _of_several(which, place)


def _of_first(count: int) -> Iterator[Pattern]:
    which = "the first" if count == 1 else f"one of the first {count}"
    yield Pattern(f"a state is {which} of those {TOGETHER}", lambda k, n: k < count)
    yield Pattern(f"a state is not {which} of those {TOGETHER}", lambda k, n: k >= count)


def _of_last(count: int) -> Iterator[Pattern]:
    which = "the last" if count == 1 else f"one of the last {count}"
    yield Pattern(f"a state is {which} of those {TOGETHER}", lambda k, n: k >= n - count)
    yield Pattern(f"a state is not {which} of those {TOGETHER}", lambda k, n: k < n - count)


def _of_several(which: str, place: int) -> Iterator[Pattern]:
    """Where one state by itself is none of them."""
    yield Pattern(
        f"a state is the {which} of several {TOGETHER}",
        lambda k, n: (k == place % n) & (n > 1),
    )
    yield Pattern(
        f"a state is requested by itself, or is not the {which} of several",
        lambda k, n: (k != place % n) | (n == 1),
    )


def _by_lanes(seen: Mapping[int, Flags]) -> Iterator[Pattern]:
    for lanes in LANES:
        yield from _of_lanes(lanes)


def _of_lanes(lanes: int) -> Iterator[Pattern]:
    """Of batches that are worked through a few states at a time: what is left, or all else."""
    left = f"left over of those {TOGETHER}, taken {lanes} at a time"
    yield Pattern(f"a state is {left}", lambda k, n: k >= n - n % lanes)
    yield Pattern(f"a state is not {left}", lambda k, n: k < n - n % lanes)
    for place in range(lanes if lanes <= MOST_PLACES else 0):
        yield from _of_lane(lanes, place)


def _of_lane(lanes: int, place: int) -> Iterator[Pattern]:
    text = f"a state is number {place + 1} of each {lanes} {TOGETHER}"
    yield Pattern(text, lambda k, n: k % lanes == place)
