"""How the share of a term goes over runs: by the number of the step, by time, or by omega.

One law must give the shares in every interval of every run that was looked at: of the runs that
fail, and of those that are sound.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator

import numpy as np

from omegadot.diagnosis.stepping.loads.share_points import Points
from omegadot.diagnosis.wording.digits import number
from omegadot.reference_impl.system import Array

TRIED, FINER = 32, 3  # numbers of a law in even ratios, and how often a finer range is tried
FAR = 30.0  # beyond, an interval that a law misses is one that it misses
Law = Callable[[Array, float], Array]  # the share at x, of a law with one number

Values = tuple[Array, Array]  # shares (p, k) within the intervals, and their means (p,)

BY_TIME: dict[str, Law] = {
    "rises evenly from 0 at t = 0 to its full size at t = {} s": lambda x, p: np.clip(x / p, 0, 1),
    "does not act until t = {} s": lambda x, p: np.where(x < p, 0.0, 1.0),
    "does not act from t = {} s on": lambda x, p: np.where(x < p, 1.0, 0.0),
    "comes to its full size as 1 - exp(-t / {} s)": lambda x, p: -np.expm1(-x / p),
    "fades as exp(-t / {} s)": lambda x, p: np.exp(-x / p),
    "grows with the time, as t / {} s": lambda x, p: x / p,
    "grows with the time, as 1 + t / {} s": lambda x, p: 1.0 + x / p,
}
BY_OMEGA: dict[str, Law] = {
    "is in proportion to |omega| below {} rad/s": lambda x, p: np.clip(x / p, 0, 1),
    "does not act where |omega| is below {} rad/s": lambda x, p: np.where(x < p, 0.0, 1.0),
    "does not act where |omega| is above {} rad/s": lambda x, p: np.where(x < p, 1.0, 0.0),
    "is |omega| / ({} rad/s) times as large as it should be": lambda x, p: x / p,
}
# Where in a step a scheme takes what depends on the time: weights at parts of the step.
PLACES: tuple[tuple[tuple[float, float], ...], ...] = (
    ((0.0, 1.0),),
    ((1.0, 1.0),),
    ((0.5, 1.0),),
    ((0.0, 1 / 6), (0.5, 2 / 3), (1.0, 1 / 6)),
    ((0.0, 0.5), (1.0, 0.5)),
    tuple(((k + 0.5) / 16, 1 / 16) for k in range(16)),
)
MOST_PERIOD = 8
HOPELESS = 5.0  # times what shares are known to, that a law misses them in the mean
BETTER = 0.8  # a law must fit by so much better than one that states less


def laws_of(points: Points) -> list[str]:
    """The laws that give every share, as text with {} for the term.

    By the number of the step, or else by the time, where runs of several steps distinguish the
    two; and by omega. Where several do, all of them: the runs do not decide.
    """
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # a mean of no numbers
        steps = points.timestep
        one_step = bool(np.ptp(steps) <= 1e-9 * steps[0])
        by_step = next(_by_step(points), "")
        by_time = "" if by_step and not one_step else _by_number(points, BY_TIME, _at_times)
        by_rate = _by_number(points, BY_OMEGA, _at_rates)
    return [text for text in (by_step, by_time, by_rate) if text]


def _by_step(points: Points) -> Iterator[str]:
    n, none = points.steps, 0.0 * points.steps
    one = 1.0 + none
    known: dict[str, Array] = {
        "in the n-th step of a run {} acts n times: what acted before is not cleared": n,
        "in the n-th step of a run {} acts n - 1 times": n - 1.0,
        "in the n-th step of a run {} is divided by n": one / n,
        "{} acts in the first step of a run alone": np.where(n == 1.0, one, none),
        "{} does not act in the first step of a run": np.where(n == 1.0, none, one),
    }
    for count in (*range(2, 21), 25, 30, 40, 50, 64, 100):
        for shift in (0, 1):
            begins = "0" if shift else f"1/{count}"
            rises = f"from {begins} in step 1 to its full size in step {count + shift}"
            known[f"{{}} rises evenly with the number of the step, {rises}"] = np.clip(
                (n - shift) / count, none, one
            )
        known[f"{{}} does not act in the first {count} steps of a run"] = np.where(
            n <= count, none, one
        )
        known[f"{{}} acts in the first {count} steps of a run alone"] = np.where(
            n <= count, one, none
        )
    for period in range(2, MOST_PERIOD + 1):
        for place in range(period):
            here = (n - 1.0) % period == place
            where = f"in one of {period} steps alone, from step {place + 1} on"
            known[f"{{}} acts {where}"] = np.where(here, one, none)
            known[f"{{}} acts {where}, {period} times as much"] = np.where(here, period, none)
            first = f"first in step {place + 1}"
            known[f"{{}} does not act in one of {period} steps, {first}"] = np.where(
                here, none, one
            )
    yield from (text for text, values in known.items() if np.all(points.missed(values) <= 1.0))


def _at_times(points: Points, law: Law, p: float) -> Iterator[Values]:
    h = points.timestep[:, None]
    for place in PLACES:
        none = 0.0 * points.steps
        parts = [law((points.steps - 1.0 + c) * h, p) + none for c, _ in place]
        weights = np.array([w for _, w in place])
        count = np.sum(np.isfinite(points.steps), axis=-1)
        values = np.stack(parts, axis=-1)
        mean = np.nansum(values @ weights, axis=-1) / count
        yield values.reshape(len(values), -1), mean


def _at_rates(points: Points, law: Law, p: float) -> Iterator[Values]:
    first, last = points.rate
    ends = np.stack((law(first, p), law(last, p)), axis=-1)
    for c in (0.0, 1.0, 0.5):
        yield ends, law(first + c * (last - first), p)


def _by_number(
    points: Points, laws: dict[str, Law], at: Callable[[Points, Law, float], Iterator[Values]]
) -> str:
    """The law that fits, with its number; "" where none does."""
    x = points.steps * points.timestep[:, None] if at is _at_times else np.stack(points.rate)
    high = float(np.nanmax(x)) * 30.0
    low = max(float(np.nanmin(x)) / 30.0, 1e-8 * high)
    best, text = 1.0 / BETTER, ""
    for statement, law in laws.items():
        near, far = low, high
        for _ in range(FINER):
            tried = np.geomspace(near, far, TRIED)
            every = [[points.missed(*v) for v in at(points, law, p)] for p in tried]
            worst = np.array([min(float(np.max(off)) for off in offs) for offs in every])
            sums = [min(float(np.sum(np.minimum(off, FAR))) for off in offs) for offs in every]
            good, k = np.flatnonzero(worst <= 1.0), int(np.argmin(sums))
            first, last = (good[0], good[-1]) if len(good) else (k, k)
            near, far = tried[max(first - 1, 0)], tried[min(last + 1, TRIED - 1)]
            if min(sums) > HOPELESS * len(points.share):
                break
        k = int(np.argmin(worst))
        if worst[k] <= BETTER * best:
            best = float(worst[k])
            text = "{} " + statement.format(
                _number(tried[first], tried[last], tried[k], "not act" in statement)
            )
    return text


def _number(low: float, high: float, best: float, sharp: bool) -> str:
    """The number of a law to the digits that are known, or between which it lies."""
    low, high = float(f"{low:.2g}"), float(f"{high:.2g}")
    if high <= 1.25 * low and (high == low or not sharp):
        return number(float(f"{best:.2g}"))
    return f"some {number(low)} to {number(high)}"
