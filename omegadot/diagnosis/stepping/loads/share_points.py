"""The shares of a term in intervals of several runs, in one row."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.stepping.loads.acting import LEFT, Shares
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.system import Array

FITS = 0.03  # of a share, or of one: within an interval a share varies
CHANGES = 0.1  # how far shares must be from one, and from each other
LEAST = 3  # intervals in which they are
MOST_POINTS = 160


@dataclass(frozen=True)
class Points:
    """Of p intervals of several runs.

    steps: (p, s), numbers from 1 on, nan beyond an interval's last.  rate: |omega| at both ends.
    explained: where the share is one for the whole interval.  run: of which run each is.
    """

    share: Array
    open: Array
    explained: NDArray[np.bool_]
    steps: Array
    timestep: Array
    rate: tuple[Array, Array]
    run: NDArray[np.intp]

    def missed(self, values: Array, mean: Array | None = None) -> Array:
        """(p,): by how much each share is missed, in parts of what it is known to.

        values: (p, k), nan where there are none, those of a law within the intervals, with their
        mean (p,). Where no share explains an interval they must change in it.
        """
        with np.errstate(all="ignore"):
            mean = np.nanmean(values, axis=-1) if mean is None else mean
            room = 2.0 * self.open + FITS * np.maximum(1.0, np.abs(mean))
            changes = np.nanmax(values, axis=-1) - np.nanmin(values, axis=-1)
            wanted = LEFT * np.maximum(np.abs(self.share - 1.0), np.abs(mean - 1.0)) / changes
            away = np.abs(self.share - mean)
            varies = np.maximum(wanted, away / (room + changes))
            off = np.where(self.explained, away / room, varies)
        return np.asarray(np.nan_to_num(off, nan=np.inf))


def points_of(shares: Sequence[Shares], scenarios: int = 2) -> Points | None:
    """The shares of one term that are known; None where too few of them, or scenarios, are off."""
    kept = [(one, np.flatnonzero(one.used)) for one in shares]
    longest = max(one.run.sweep.every for one, _ in kept)
    numbers = np.arange(longest)

    def steps(one: Shares) -> Array:
        every = one.run.first_steps[:, None] + numbers
        return np.where(numbers < one.run.sweep.every, every, np.nan)

    def joined(of: Callable[[Shares], NDArray[Any]]) -> NDArray[Any]:
        return np.concatenate([of(one)[used] for one, used in kept])

    points = Points(
        joined(lambda one: one.share),
        joined(lambda one: one.open),
        joined(lambda one: one.explained),
        joined(steps),
        joined(lambda one: np.full(len(one.share), one.run.sweep.timestep)),
        (joined(lambda one: _rate(one)[:-1]), joined(lambda one: _rate(one)[1:])),
        np.concatenate([np.full(len(used), k) for k, (_, used) in enumerate(kept)]),
    )
    off = points.explained & (np.abs(points.share - 1.0) > CHANGES + points.open)
    names = {kept[k][0].run.name for k in np.unique(points.run[off])}
    if np.count_nonzero(off) < LEAST or len(names) < scenarios or not _varies(points):
        return None
    return _few(points, off | ~points.explained)


def _rate(one: Shares) -> Array:
    return norm(one.run.state.angular_velocity)


def _varies(points: Points) -> bool:
    """Whether the share changes within one run: a number that is wrong is the same throughout."""
    runs = [points.explained & (points.run == k) for k in np.unique(points.run)]
    return any(
        float(np.max((points.share - points.open)[one])) - CHANGES
        > float(np.min((points.share + points.open)[one]))
        for one in runs
        if one.any()
    )


def _few(points: Points, off: NDArray[np.bool_]) -> Points:
    """As many as are tried, evenly, half of them of those that are off."""
    both = [np.flatnonzero(off), np.flatnonzero(~off)]
    half = MOST_POINTS // 2
    kept = [one[np.linspace(0, len(one) - 1, min(half, len(one))).astype(int)] for one in both]
    order = np.concatenate(kept)
    first, last = points.rate
    names = ("share", "open", "explained", "steps", "timestep", "run")
    fields = {name: getattr(points, name)[order] for name in names}
    return Points(**fields, rate=(first[order], last[order]))
