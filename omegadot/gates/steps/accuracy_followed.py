"""Whether the errors of an error-controlled integrator follow the accuracies requested of it.

The rules are those of `gates.accuracy`: an error is held to those at finer accuracies, and the
errors of the finest runs to rounding, to the accuracy itself, or to how they shrink.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.gates.case import Sweep
from omegadot.gates.errors.measured_run import CHANNELS, ROTATION
from omegadot.gates.errors.observed_order import ORDER_TOLERANCE
from omegadot.gates.errors.verdicts import Finding
from omegadot.gates.rows import Row
from omegadot.gates.steps.accuracy import (
    FINER,
    GATE,
    AccuracyRun,
    finest_of,
    pace,
    steps_per_radian,
)
from omegadot.gates.truth import Truth
from omegadot.reference_impl.system import Array
from omegadot.written import written

# Steps of order 1 go with the root of the accuracy, and their error as far as an order shows.
LEAST_SLOPE, MOST_SLOPE = 0.5 * (1.0 - ORDER_TOLERANCE), 2.0
SATURATED = 0.5  # rad, or of the size of omega
CLEAR_OF_ROUNDING = 10.0  # rounding is then a tenth of an error at most
HORIZONS = tuple(0.5**n for n in range(7))  # of a run's samples
MOST_OWN_STEPS = 2e5  # in a run that is only made to see whether errors go on to shrink


def _coarse_first(runs: Sequence[AccuracyRun]) -> list[AccuracyRun]:
    """By accuracy; runs of the finest by the spacing of their samples."""
    return sorted(runs, key=lambda run: (run.sweep.knob, run.sweep.timestep), reverse=True)


def _shares(run: AccuracyRun, channel: str) -> Array:
    """(n,): the error in parts of what rounding and the exact answer leave open."""
    bound: Array = run.round_off[channel] + run.floor.get(channel, 0.0)
    error = run.error[channel]
    return np.where(error == 0.0, 0.0, error / np.maximum(bound, np.finfo(float).tiny))


def _is_round(run: AccuracyRun, channel: str) -> bool:
    """Whether an error is about as small as rounding throughout."""
    return float(np.max(_shares(run, channel))) <= CLEAR_OF_ROUNDING


def _unsaturated(*runs: AccuracyRun) -> int:
    """The samples of the longest horizon on which no run is off by the size of the motion."""
    samples = 2
    for horizon in HORIZONS:
        samples = max(2, math.ceil(horizon * len(runs[0].sweep.times)))
        if all(np.max(run.error[c][:samples]) <= SATURATED for run in runs for c in ROTATION):
            break
    return samples


@dataclass(frozen=True)
class Pair:
    """A run and a finer one, in one channel: their largest errors, the finer one's rounding, up to
    where the latter stands clearest of it.


    factor: by how much the accuracy is finer, or else the spacing of the samples.
    """

    coarse: float
    fine: float
    rounding: float
    factor: float

    @property
    def slope(self) -> float:
        """The power of the factor by which the error shrinks."""
        if not 0.0 < self.fine <= self.coarse < math.inf:
            return math.inf if self.fine == 0.0 else 0.0
        return math.log(self.coarse / self.fine) / math.log(self.factor)

    @property
    def leaps(self) -> bool:
        """Whether the coarser one's error is larger than the finer one's lets it be."""
        return self.coarse > max(self.fine, self.rounding) * math.pow(self.factor, MOST_SLOPE)


def _pair(coarse: AccuracyRun, fine: AccuracyRun, channel: str, *, whole: bool = False) -> Pair:
    """whole: up to where errors saturate."""
    samples = _unsaturated(coarse, fine)
    clearest = 1 + int(np.argmax(_shares(fine, channel)[:samples]))
    until = samples if whole else clearest
    bound = fine.round_off[channel] + fine.floor.get(channel, 0.0)
    sizes = (coarse.error[channel], fine.error[channel], bound)
    one, other = coarse.sweep, fine.sweep
    spacing = one.accuracy == other.accuracy
    factor = one.timestep / other.timestep if spacing else one.knob / other.knob
    largest = [float(np.max(size[:until])) for size in sizes]
    return Pair(largest[0], largest[1], largest[2], factor)


def _slope(coarse: AccuracyRun, fine: AccuracyRun, channel: str) -> float:
    """The larger one of where errors are clearest of rounding and of all of them.

    A motion that starts at rest is clearest of rounding at its first samples, to which any accuracy
    takes it in the same few small steps.
    """
    return max(_pair(coarse, fine, channel, whole=every).slope for every in (False, True))


def _split(runs: Sequence[AccuracyRun]) -> tuple[list[AccuracyRun], list[AccuracyRun]]:
    """The runs over accuracies, and those of the finest over the spacing of the samples."""
    spacing = max(run.sweep.timestep for run in runs)
    over = [run for run in runs if run.sweep.timestep == spacing]
    return over, [run for run in runs if run.sweep.knob == over[-1].sweep.knob]


def _follows(runs: Sequence[AccuracyRun], channel: str) -> Finding:
    """Whether the error follows the accuracy down to rounding, by the finest runs."""
    over, spaced = _split(runs)
    finest = spaced[-1]
    error = float(np.max(finest.error[channel]))
    text = f"{written(error, 2)} at an accuracy of {written(finest.sweep.knob)}"
    if _is_round(finest, channel):
        return Finding("consistent", f"follows its accuracy down to rounding: {text}")
    if np.all(finest.error[channel] <= finest.kept[channel]):
        return Finding("consistent", f"keeps its accuracy: {text}")
    for what, these in (("its accuracy", over), ("the spacing of its samples", spaced)):
        slope = _slope(these[-2], these[-1], channel) if len(these) > 1 else 0.0
        if slope >= LEAST_SLOPE:
            return Finding("consistent", f"follows {what}: {text}, slope {slope:.2f}")
    if len(runs) < 2:
        return Finding("unresolved", "one accuracy cannot show whether the error follows it")
    return Finding("unexplained", f"does not follow its accuracy: the error stays at {text}")


def _keeps(run: AccuracyRun, channel: str) -> bool:
    """Whether an error is within what its accuracy leaves open, which is not everything.

    A method that changes its order with the accuracy, or begins anew at every sample with a short
    step of order 1, keeps its accuracy and follows no power of it.
    """
    resolves = float(np.max(run.kept["attitude"])) <= SATURATED
    return resolves and bool(np.all(run.error[channel] <= run.kept[channel]))


def _finding(measured: AccuracyRun, runs: Sequence[AccuracyRun], channel: str) -> Finding:
    error, bound = measured.error[channel], measured.round_off[channel]
    if not np.all(np.isfinite(error)):
        return Finding("unexplained", "not finite")
    if np.all(error <= bound):
        return Finding("round-off", "within round-off")
    if np.all(error <= bound + measured.floor.get(channel, 0.0)):
        return Finding("beyond", "not judged: below the resolvable floor of this motion")
    over, _ = _split(runs)
    for finer in [] if _keeps(measured, channel) else over[over.index(measured) + 1 :]:
        pair = _pair(measured, finer, channel)
        if pair.leaps:
            times = pair.coarse / max(pair.fine, pair.rounding)
            at = written(finer.sweep.knob)
            text = f"at this accuracy the error is {written(times, 1)} times that at {at}"
            return Finding("unexplained", text)
    return _follows(runs, channel)


def findings_of(measured: AccuracyRun, measured_runs: Sequence[AccuracyRun]) -> dict[str, Finding]:
    """Judge every channel of one run by the others of its sweep."""
    runs = _coarse_first(measured_runs)
    return {channel: _finding(measured, runs, channel) for channel in CHANNELS}


def finer_sweep(
    truth: Truth, integrator: Integrator, measured_runs: Sequence[AccuracyRun]
) -> Sweep | None:
    """The sweep to go on with where errors stand clear of rounding; None at the end.

    A finer accuracy; where there is none, or it takes too many steps, and the errors do not
    follow, samples that are closer together.
    """
    runs = _coarse_first(measured_runs)
    clear = [channel for channel in CHANNELS if not _is_round(runs[-1], channel)]
    if not clear:
        return None
    over, spaced = _split(runs)
    sweep = over[-1].sweep
    finer = max(finest_of(integrator), sweep.knob / FINER)
    steps = pace(truth) * float(sweep.times[-1]) * steps_per_radian(integrator, finer)
    if len(spaced) == 1 and finer < 0.5 * sweep.knob and steps <= MOST_OWN_STEPS:
        return replace(sweep, accuracy=finer)
    last = spaced[-1].sweep
    still = []
    if len(over) > 1:
        still = [c for c in clear if _slope(over[-2], over[-1], c) < LEAST_SLOPE]
    if len(spaced) > 1:
        still = [c for c in still if _slope(spaced[-2], spaced[-1], c) >= LEAST_SLOPE]
    return last.refined(4) if still and 4 * last.steps <= MOST_OWN_STEPS else None


def rows(measured: AccuracyRun, measured_runs: Sequence[AccuracyRun]) -> list[Row]:
    """By channel: the slope of the error over the two finest accuracies, where it shows one, and
    the error in parts of the accuracy.
    """
    over, _ = _split(_coarse_first(measured_runs))
    found = []
    for channel in CHANNELS:
        if len(over) > 1 and not _is_round(over[-1], channel):
            slope = _pair(over[-2], over[-1], channel).slope
            found.append(Row(GATE, channel, "accuracy_slope", slope, "1", LEAST_SLOPE))
        kept = measured.kept[channel]
        share = float(np.max(measured.error[channel][1:] / kept[1:], initial=0.0))
        found.append(Row(GATE, channel, "parts_of_accuracy", share, "1"))
    return found
