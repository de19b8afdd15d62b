"""Steps that are not taken, or taken twice, while the clock goes on: by their number in a run."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf

SCENARIOS = 2  # at least, that show it
MOST_NUMBERS = 64  # in question for the first such step, and for those from one to the next
ALONE = 2**62  # steps from one to the next, of one that is alone
KINDS = {
    -1: "is not taken, and the clock goes on",
    1: "is taken twice, and the clock goes on by one step",
}
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class _Run:
    """Of a run's intervals: the first and last step of each, and by what they are made.

    right: by as many steps as are due.  other: by one step fewer, or more.
    """

    name: str
    timestep: float
    first: NDArray[np.intp]
    last: NDArray[np.intp]
    right: Mask
    other: Mask

    @property
    def shown(self) -> Mask:
        """Which have a step too few or too many, and no other reason is known."""
        return self.other & ~self.right


def skipped_steps(by: SchemeOf, runs: Sequence[KeptRun]) -> list[str]:
    """Which steps of a run are not taken, or taken twice; none where all runs have no law of it."""
    right = dict[int, Mask]()
    for more, how in KINDS.items():
        wrong, shown = list[int](), set[str]()
        for number, run in sorted(enumerate(runs), key=lambda pair: pair[1].sweep.every):
            if not run.fails:
                continue
            if number not in right:
                right[number] = run.sound(by)
            if not np.all(right[number]):
                one = _sorted(by, run, more, right[number])
                if 2 * np.count_nonzero(one.shown) < np.count_nonzero(~one.right):
                    break  # it is wrong by something else
                wrong.append(number)
                shown.add(run.name)
        else:
            if len(shown) >= SCENARIOS:
                every = [_sorted(by, run, more, right.get(k)) for k, run in enumerate(runs)]
                text = _law(every, how)
                return [text] if text else []
            if not wrong:
                return []
    return []


def _sorted(by: SchemeOf, run: KeptRun, more: int, right: Mask | None) -> _Run:
    first, other = run.first_steps, run.made(by, run.sweep.every + more)
    last, right = first + run.sweep.every - 1, run.sound(by) if right is None else right
    return _Run(run.name, run.sweep.timestep, first, last, right, other)


def _law(runs: Sequence[_Run], how: str) -> str:
    """The steps that are in every such interval and in no other, as text; "" where none are."""
    begins = [(run.first[run.shown][0], run.last[run.shown][0]) for run in runs if run.shown.any()]
    low, high = max(first for first, _ in begins), min(last for _, last in begins)
    numbers = range(int(low), min(int(high), int(low) + MOST_NUMBERS) + 1)
    once = [n for n in numbers if all(_holds(run, n) for run in runs)]
    if once:
        return f"step {_between(once)} of a run {how}"
    pairs = ((n, period) for n in numbers for period in _periods(runs, n))
    laws = [pair for pair in pairs if all(_holds(run, *pair) for run in runs)]
    # the multiples of one number state less
    multiples = [law for law in laws if law[0] == law[1]]
    if not laws:
        return ""
    first, period = (_between(sorted(set(one))) for one in zip(*(multiples or laws), strict=True))
    if multiples:
        return f"of every {period} steps of a run the last {how}"
    return f"of every {period} steps of a run one {how}: first step {first}"


def _between(numbers: Sequence[int]) -> str:
    """A number, or between which two it lies."""
    beside = len(numbers) == 2 and numbers[1] == numbers[0] + 1
    ends = dict.fromkeys((str(numbers[0]), str(numbers[-1])))
    return (" or " if beside else " to ").join(ends)


def _periods(runs: Sequence[_Run], first: int) -> Iterator[int]:
    """From the first such step to the next, of the run that shows it best."""
    later = [
        (int(run.first[k]) - first, int(run.last[k]) - first)
        for run in runs
        for k in np.flatnonzero(run.shown & (run.first > first))[:1]
    ]
    if not later:
        return  # no run shows a second one
    low, high = max(low for low, _ in later), min(high for _, high in later)
    yield from range(max(low, 1), min(high, low + MOST_NUMBERS) + 1)


def _holds(run: _Run, first: int, period: int = ALONE) -> bool:
    """Whether it is this step, and each a period later, by what the run shows."""
    upto, before = ((numbers - first) // period for numbers in (run.last, run.first - 1))
    many = np.maximum(upto + 1, 0) - np.maximum(before + 1, 0)
    good = np.where(many == 0, run.right, np.where(many == 1, run.other, ~run.right))
    return bool(np.all(good))
