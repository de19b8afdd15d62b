"""Gates 3 to 5 for an error-controlled integrator: its error must follow the accuracy requested.

Such an integrator takes steps h of its own, so that an estimate of the local error stays within a
tolerance t. Where that estimate is of the order ``h^(p+1)``, h is proportional to ``t^(1/(p+1))``,
and the error of the run to ``t^(p/(p+1))``, or to t where the better of two solutions is kept or
the error per unit of time is held (Hairer, Norsett and Wanner, "Solving Ordinary Differential
Equations I", II.4; Shampine 1977). The exponent is 1/2 at least (p = 1), and 2 at most (the last
two together). Two things interrupt this: rounding, and steps that are shorter than the tolerance
requires, for they end at a sample. The error of those shrinks with the spacing of the samples. That
of a fault shrinks with neither.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.gates.case import ACCURACIES, Sweep
from omegadot.gates.measured_run import CHANNELS, ROTATION, MeasuredRun, measure
from omegadot.gates.rows import Row
from omegadot.gates.truth import Truth
from omegadot.gates.vanishing_step import Tolerated
from omegadot.gates.verdicts import Finding
from omegadot.reference_impl.system import Array, State

GATE = "scheme"
LEAST_SLOPE, MOST_SLOPE = 0.5, 2.0
SATURATED = 0.5  # rad, or of the size of omega
CLEAR_OF_ROUNDING = 10.0
HORIZONS = tuple(0.5**n for n in range(7))  # of a run's samples
FIXED = "not judged: its accuracy cannot be set through this adapter"
FINEST = 1e-13  # 450 roundings of a double; an estimate of the error rounds as well
FINER = 100.0
MOST_OWN_STEPS = 2e5


def finest_of(integrator: Integrator) -> float:
    """The finest accuracy that is requested of an integrator."""
    return max(FINEST, integrator.finest_accuracy)


def usual_for(integrator: Integrator) -> float | None:
    """The accuracy of an integrator that is run at one alone; None where it is run in steps."""
    if integrator.knob != "accuracy":
        return None
    return max(ACCURACIES[-1], integrator.finest_accuracy)


def tolerated_by(integrator: Integrator) -> Tolerated:
    """What steps of the finest accuracy may be off; nothing where there is no accuracy."""
    known = integrator.knob == "accuracy" or integrator.finest_accuracy
    if integrator.knob == "timestep" or not known:
        return Tolerated()
    accuracy = finest_of(integrator)
    return Tolerated(accuracy, accuracy * steps_per_radian(integrator, accuracy))


@dataclass(frozen=True)
class AccuracyRun(MeasuredRun):
    """A measured run of an error-controlled integrator.

    kept: (n,) by channel, what is off where each radian of the motion adds the accuracy requested.
    """

    kept: dict[str, Array] = field(default_factory=dict)


def order_of(integrator: Integrator) -> int:
    """The least order p that an integrator declares for the turning, 1 without one."""
    declared = (integrator.orders.get(channel) for channel in ROTATION)
    return max(1, min((order for order in declared if order), default=1))


def pace(truth: Truth) -> float:
    """1/s: the radians that a motion makes in a second, or the rate at which its omega changes."""
    return truth.yardstick.rate + truth.yardstick.acceleration / truth.yardstick.rate


def steps_per_radian(integrator: Integrator, accuracy: float) -> float:
    """About how many steps of its own an integrator takes: ``t^(-1/(p+1))``."""
    return math.exp(-math.log(accuracy) / (order_of(integrator) + 1))


def measure_accuracy(
    truth: Truth, integrator: Integrator, sweep: Sweep, state: State
) -> AccuracyRun:
    """As `measure`, with the rounding of the integrator's own steps."""
    measured = measure(truth, sweep, state, None)
    assert sweep.accuracy is not None
    yardstick, growth = truth.yardstick, truth.growth[truth.rows(sweep)]
    radians = pace(truth) * sweep.times
    between = pace(truth) * sweep.timestep * steps_per_radian(integrator, sweep.accuracy)
    within = max(1.0, between)
    bound = yardstick.round_off(sweep.timestep / within, within * sweep.sample_steps, growth)
    rounding = yardstick.round_off(0.0, np.zeros(1), np.ones(1))["omega"][0]
    roundings = sweep.accuracy * (1.0 + radians) / rounding
    kept = yardstick.round_off(sweep.times / roundings, roundings, growth)
    own = {**vars(measured), "round_off": bound}
    return AccuracyRun(**own, kept=kept)


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


def _pair(coarse: AccuracyRun, fine: AccuracyRun, channel: str) -> Pair:
    samples = _unsaturated(coarse, fine)
    until = 1 + int(np.argmax(_shares(fine, channel)[:samples]))  # where it is clearest of rounding
    bound = fine.round_off[channel] + fine.floor.get(channel, 0.0)
    sizes = (coarse.error[channel], fine.error[channel], bound)
    one, other = coarse.sweep, fine.sweep
    spacing = one.accuracy == other.accuracy
    factor = one.timestep / other.timestep if spacing else one.knob / other.knob
    largest = [float(np.max(size[:until])) for size in sizes]
    return Pair(largest[0], largest[1], largest[2], factor)


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
    text = f"{error:.1e} at an accuracy of {finest.sweep.knob:g}"
    if _is_round(finest, channel):
        return Finding("consistent", f"follows its accuracy down to rounding: {text}")
    if np.all(finest.error[channel] <= finest.kept[channel]):
        return Finding("consistent", f"keeps its accuracy: {text}")
    for what, these in (("its accuracy", over), ("the spacing of its samples", spaced)):
        slope = _pair(these[-2], these[-1], channel).slope if len(these) > 1 else 0.0
        if slope >= LEAST_SLOPE:
            return Finding("consistent", f"follows {what}: {text}, slope {slope:.2f}")
    if len(runs) < 2:
        return Finding("unresolved", "one accuracy cannot show whether the error follows it")
    return Finding("unexplained", f"does not follow its accuracy: the error stays at {text}")


def _finding(measured: AccuracyRun, runs: Sequence[AccuracyRun], channel: str) -> Finding:
    error, bound = measured.error[channel], measured.round_off[channel]
    if not np.all(np.isfinite(error)):
        return Finding("unexplained", "not finite")
    if np.all(error <= bound):
        return Finding("round-off", "within round-off")
    if np.all(error <= bound + measured.floor.get(channel, 0.0)):
        return Finding("beyond", "not judged: below the resolvable floor of this motion")
    over, _ = _split(runs)
    for finer in over[over.index(measured) + 1 :]:
        pair = _pair(measured, finer, channel)
        if pair.leaps:
            times = pair.coarse / max(pair.fine, pair.rounding)
            text = f"at this accuracy the error is {times:.0e} times that at {finer.sweep.knob:g}"
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
        still = [c for c in clear if _pair(over[-2], over[-1], c).slope < LEAST_SLOPE]
    if len(spaced) > 1:
        still = [c for c in still if _pair(spaced[-2], spaced[-1], c).slope >= LEAST_SLOPE]
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


def fixed(findings: dict[str, Finding]) -> dict[str, Finding]:
    """The findings where the accuracy cannot be set, so that no error shows a fault."""
    return {channel: _fixed(finding) for channel, finding in findings.items()}


def _fixed(finding: Finding) -> Finding:
    judged = finding.kind in ("round-off", "explained", "consistent", "beyond")
    return finding if judged or finding.note == "not finite" else Finding("beyond", FIXED)


def fixed_orders(found: Sequence[Row]) -> list[Row]:
    """The rows of observed orders where the accuracy cannot be set: a step shows no order then."""
    return [replace(r, verdict="info", note=FIXED) if r.verdict == "fail" else r for r in found]
