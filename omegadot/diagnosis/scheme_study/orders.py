"""The observed order of an error: a sweep that refines itself until the slope has settled."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.diagnosis.scheme_study.probes import Probe, truth_of
from omegadot.diagnosis.scheme_study.subject import Stepper
from omegadot.gates.errors.measured_run import CHANNELS
from omegadot.gates.errors.observed_order import ORDER_TOLERANCE
from omegadot.harness.judging.judged_run import is_finite

COARSEST = 0.4  # rad a step: an error of order 4 then has decades to go before it meets rounding
SAMPLES = 10  # the steps of the coarsest run, all of them kept: 4 rad in all
MOST_HALVINGS = 9
# Where each halving halves what a slope lacks, three slopes that spread by s have a mean within
# 0.8 s of the order. The sweep goes on to half the tolerance; where rounding comes first, the whole
# of it will do.
SPREADS = (ORDER_TOLERANCE / 2, ORDER_TOLERANCE)
FEWEST_SLOPES = 3


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
    spread: how far apart the slopes are that it was regressed over.
    """

    kind: str
    order: float | None = None
    spread: float = 0.0


def observe(points: Iterable[Point]) -> Observed:
    """Regress log error on log step over the settled part of a sweep, above the floor.

    The settled part starts at the finest step whose error is clear of rounding and goes on to
    coarser ones as long as the slopes of neighbouring steps spread no more than they may.
    """
    ordered = sorted(points, key=lambda point: point.timestep)
    first = next((n for n, point in enumerate(ordered) if point.error > point.bound), None)
    if first is None:
        return Observed("floor" if ordered else "unresolved")
    steps, errors = np.log([(point.timestep, point.error) for point in ordered[first:]]).T
    slopes = np.diff(errors) / np.diff(steps)
    for spread in SPREADS:
        count = _settled(slopes.tolist(), spread)
        if count >= FEWEST_SLOPES:
            order = float(np.polyfit(steps[: count + 1], errors[: count + 1], 1)[0])
            return Observed("settled", order, float(np.ptp(slopes[:count])))
    return Observed("unresolved", float(slopes[0]) if len(slopes) else None)


def _settled(slopes: Sequence[float], spread: float) -> int:
    """How many slopes, from the finest on, spread by no more than this."""
    counts = range(len(slopes))
    return next((n for n in counts if np.ptp(slopes[: n + 1]) > spread), len(slopes))


def _decided(points: Sequence[Point]) -> bool:
    """Whether finer steps can add nothing: the order is sharp, or the finest two are rounding."""
    finest = sorted(points, key=lambda point: point.timestep)[:2]
    if len(finest) == 2 and all(point.error <= point.bound for point in finest):
        return True
    found = observe(points)
    return found.kind == "settled" and found.spread <= SPREADS[0]


def sweep(measure: Callable[[int], Mapping[str, Point] | None]) -> dict[str, list[Point]]:
    """Halve the step until every channel has settled or reached its floor.

    measure: the errors at ``COARSEST / 2^halvings``, None where the run blew up.
    """
    points: dict[str, list[Point]] = {channel: [] for channel in CHANNELS}
    for halvings in range(MOST_HALVINGS + 1):
        found = measure(halvings)
        for channel, point in (found or {}).items():
            points[channel].append(point)
        if halvings >= FEWEST_SLOPES and all(_decided(p) for p in points.values()):
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
        measured = step(probe.initial, timestep, steps, finer)
        if not is_finite(measured):
            return None
        numbers = np.arange(0, steps + 1, finer)
        bound = truth.yardstick.round_off(timestep, numbers, truth.growth)
        return {
            channel: Point(
                timestep,
                float(np.max(truth.yardstick.distance(channel, measured, truth.state))),
                float(np.max(bound[channel])),
            )
            for channel in CHANNELS
        }

    return sweep(measure)
