"""Samples that are the state of another step than their time's, by their number in every run.

The times are right, and so are all other samples. Of a sample that is k steps early, k steps too
few lead from the sample before to it, and k too many from it to the next.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf, scheme_of
from omegadot.reference_impl.system import State

LEAST = 3  # runs that show it
MOST_SHIFT = 3  # steps by which a sample is off
ALONE = 2**62  # samples from one to the next, of one that is alone
COUNTS = ("no step", "one step", "two steps", "three steps")
ALL_BUT_ENDS = 4  # samples of a run that show it: the first, two that are moved, and the last
FIRST = "the first sample after the start"
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Moved:
    """statement: which samples are moved.  names: of the scenarios that this explains."""

    statement: str
    names: frozenset[str]


@dataclass(frozen=True)
class _Law:
    """first: the number of the first sample that is moved.  period: from one to the next.

    but_last: whether the last sample of a run is right, whatever its number.
    """

    shift: int
    first: int
    period: int
    but_last: bool = False

    def steps_of(self, run: KeptRun) -> NDArray[np.intp]:
        """(n,): the number of the step that each sample is of; none is before the start."""
        numbers = run.sweep.sample_steps[: len(run.times)]
        later = np.arange(len(numbers)) - self.first
        moved = (later >= 0) & (later % self.period == 0)
        moved[len(run.sweep.sample_steps) - 1 :] &= not self.but_last
        return np.asarray(np.maximum(numbers + self.shift * moved, 0))

    @property
    def statement(self) -> str:
        """Which samples, and by how many steps."""
        way = "early" if self.shift < 0 else "further"
        off = f"is the state {COUNTS[abs(self.shift)]} {way}, at the right time"
        if self.but_last:
            return f"every sample of a run but the first and the last {off}"
        if self.period == ALONE:
            return f"{FIRST if self.first == 1 else f'sample {self.first} of a run'} {off}"
        if self.first == self.period:
            return f"of every {self.period} samples of a run the last {off}"
        return f"of every {self.period} samples of a run one {off}: first sample {self.first}"


def moved_samples(integrator: Integrator, kept: Sequence[KeptRun]) -> Moved | None:
    """Which samples of all runs are of another step; None where one run has others, or none is."""
    failing = sorted((run for run in kept if run.fails), key=lambda run: run.sweep.every)
    with np.errstate(all="ignore"):
        by = scheme_of(integrator, kept) if len(failing) >= LEAST else None
        if by is None:
            return None
        # all samples of a run are looked at only once its first have shown nothing else
        few = [_Run(run.short, by) for run in failing[:LEAST]]
        whole = [_Run(run, by) for run in (*failing, *(run for run in kept if not run.fails))]
        for law in _laws(few):
            if all(one.follows(law) for one in few):
                names = _shown(law, whole)
                if names:
                    return Moved(law.statement, names)
    return None


class _Run:
    """A run, and by which numbers of steps its samples follow each other."""

    def __init__(self, run: KeptRun, by: SchemeOf) -> None:
        self.run, self._by = run, by
        self._made: dict[int, Mask] = {}

    def made(self, count: int) -> Mask:
        """(n - 1,): whether so many steps lead from each sample to the next.

        Below none they lead from the next to this one.
        """
        if count not in self._made:
            run = self.run if count >= 0 else _backwards(self.run)
            made = run.made(self._by, abs(count))
            self._made[count] = made if count >= 0 else made[::-1]
        return self._made[count]

    @property
    def is_whole(self) -> bool:
        """Whether its last sample is kept, and two at least are between it and the first."""
        return ALL_BUT_ENDS <= len(self.run.times) == len(self.run.sweep.times)

    @property
    def right(self) -> Mask:
        """(n - 1,): by as many as are due."""
        return self.made(self.run.sweep.every)

    def moved(self, law: _Law) -> Mask:
        """(n - 1,): the intervals that a law changes."""
        return np.asarray(np.diff(law.steps_of(self.run)) != self.run.sweep.every)

    def follows(self, law: _Law) -> bool:
        """Whether the intervals that a law changes are as it has them."""
        counts = np.diff(law.steps_of(self.run))[self.moved(law)]
        places = np.flatnonzero(self.moved(law))
        return all(self.made(int(n))[k] for n, k in zip(counts, places, strict=True))


def _backwards(run: KeptRun) -> KeptRun:
    """Its samples from the last to the first; the bounds of an interval are those of its end."""
    state = State(*(f[::-1] for f in vars(run.state).values()))
    return replace(run, state=state, bounds={c: b[::-1] for c, b in run.bounds.items()})


def _laws(few: Sequence[_Run]) -> Iterator[_Law]:
    """All but the ends, the first sample alone, then what a run shows, by fewer steps first."""
    for shift in (sign * k for k in range(1, MOST_SHIFT + 1) for sign in (-1, 1)):
        yield _Law(shift, 1, 1, but_last=True)
        yield _Law(shift, 1, ALONE)
        for one in few:
            every = one.run.sweep.every
            early, late = (one.made(every + sign * shift) & ~one.right for sign in (1, -1))
            places = np.flatnonzero(early[:-1] & late[1:]) + 1
            if len(places):
                period = int(places[1] - places[0]) if len(places) > 1 else ALONE
                yield _Law(shift, int(places[0]), period)
                break


def _shown(law: _Law, runs: Sequence[_Run]) -> frozenset[str]:
    """The scenarios that show it and nothing else; none where a run contradicts it."""
    count, shown, others = 0, set[str](), set[str]()
    for one in runs:
        if not one.follows(law):
            return frozenset()
        changed, name = one.moved(law), one.run.name
        others |= set() if np.all(one.right | changed) else {name}
        if not np.all(one.right[changed]):
            count += not law.but_last or one.is_whole
            shown.add(name)
    return frozenset(shown - others) if count >= LEAST else frozenset()
