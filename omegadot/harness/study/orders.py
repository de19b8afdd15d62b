"""The observed order of an error: a sweep that refines itself until the slope has settled."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.harness.gates.course import CHANNELS
from omegadot.harness.study.probes import Probe, truth_of
from omegadot.harness.study.subject import Stepper, is_finite
from omegadot.harness.verdicts import ORDER_TOLERANCE

COARSEST = 0.4  # rad a step: an error of order 4 then has decades to go before it meets rounding
SAMPLES = 20  # the steps of the coarsest run, all of them kept: 8 rad in all
MOST_HALVINGS = 9
# Where each halving halves what a slope lacks, slopes that spread by this much miss the order by
# less: half the tolerance leaves room for those that do not shrink as fast.
SPREAD = ORDER_TOLERANCE / 2
FEWEST_SLOPES = 3
AT_THE_FLOOR = 2  # so many finest steps within rounding end a sweep


@dataclass(frozen=True)
class Point:
    """The largest error of one run, and how far rounding alone may have taken it."""

    timestep: float
    error: float
    bound: float


@dataclass(frozen=True)
class Observed:
    """kind: "settled", "floor" (nothing above rounding) or "unresolved".

    order: the regressed slope; where it is unresolved the finest one, None where there is none.
    """

    kind: str
    order: float | None = None


def observe(points: Iterable[Point]) -> Observed:
    """Regress log error on log step over the settled part of a sweep, above the floor.

    The settled part starts at the finest step whose error is clear of rounding and goes on to
    coarser ones as long as the slopes of neighbouring steps spread by no more than SPREAD.
    """
    ordered = sorted(points, key=lambda point: point.timestep)
    first = next((n for n, point in enumerate(ordered) if point.error > point.bound), None)
    if first is None:
        return Observed("floor" if ordered else "unresolved")
    clear = ordered[first:]
    logs = np.log([(point.timestep, point.error) for point in clear]).T
    slopes = np.diff(logs[1]) / np.diff(logs[0])
    count = _settled(slopes.tolist())
    if count < FEWEST_SLOPES:
        return Observed("unresolved", float(slopes[0]) if len(slopes) else None)
    return Observed("settled", float(np.polyfit(logs[0, : count + 1], logs[1, : count + 1], 1)[0]))


def _settled(slopes: Sequence[float]) -> int:
    """How many slopes, from the finest on, spread by no more than SPREAD."""
    count = 0
    while count < len(slopes) and np.ptp(slopes[: count + 1]) <= SPREAD:
        count += 1
    return count


def _at_the_floor(points: Sequence[Point]) -> bool:
    finest = sorted(points, key=lambda point: point.timestep)[:AT_THE_FLOOR]
    return len(finest) == AT_THE_FLOOR and all(p.error <= p.bound for p in finest)


def sweep(measure: Callable[[int], Mapping[str, Point] | None]) -> dict[str, list[Point]]:
    """Halve the step until every channel has settled or reached its floor.

    measure: the errors at ``COARSEST / 2^halvings``, None where the run blew up.
    """
    points: dict[str, list[Point]] = {channel: [] for channel in CHANNELS}
    for halvings in range(MOST_HALVINGS + 1):
        found = measure(halvings)
        for channel, point in (found or {}).items():
            points[channel].append(point)
        decided = (observe(p).kind == "settled" or _at_the_floor(p) for p in points.values())
        if halvings >= FEWEST_SLOPES and all(decided):
            break
    return points


def global_errors(probe: Probe, step: Stepper) -> dict[str, list[Point]]:
    """A sweep of the accumulated error, per channel: its largest over the same instants.

    Raises NoAnswerError.
    """
    coarsest = probe.timestep(COARSEST)
    truth = truth_of(probe, tuple((coarsest * np.arange(SAMPLES + 1)).tolist()))

    def measure(halvings: int) -> dict[str, Point] | None:
        finer = 2**halvings
        timestep, steps = coarsest / finer, SAMPLES * finer
        course = step(probe.initial, timestep, steps, finer)
        if not is_finite(course):
            return None
        numbers = np.arange(0, steps + 1, finer)
        bound = truth.yardstick.round_off(timestep, numbers, truth.growth)
        return {
            channel: Point(
                timestep,
                float(np.max(truth.yardstick.distance(channel, course, truth.state))),
                float(np.max(bound[channel])),
            )
            for channel in CHANNELS
        }

    return sweep(measure)
