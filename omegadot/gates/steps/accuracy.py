"""Gates 3 to 5 for an error-controlled integrator: its error must follow the accuracy requested.

Such an integrator takes steps h of its own, so that an estimate of the local error stays within a
tolerance t. Where that estimate is of the order ``h^(p+1)``, h is proportional to ``t^(1/(p+1))``,
and the error of the run to ``t^(p/(p+1))``, or to t where the better of two solutions is kept or
the error per unit of time is held (Hairer, Norsett and Wanner, "Solving Ordinary Differential
Equations I", II.4; Shampine 1977). The exponent is 1/2 at least (p = 1), and 2 at most (the last
two together). Two things interrupt this: rounding, and steps that are shorter than the tolerance
requires, for they end at a sample. The error of those shrinks with the
timestep that is requested. That of a fault shrinks with neither.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.gates.case import ACCURACIES, Sweep
from omegadot.gates.errors.measured_run import ROTATION, MeasuredRun, measure
from omegadot.gates.errors.verdicts import Finding
from omegadot.gates.rows import Row
from omegadot.gates.steps.limits import Tolerated
from omegadot.gates.truth import Truth
from omegadot.reference_impl.system import Array, State

GATE = "scheme"
FIXED = "not judged: its accuracy cannot be set through this adapter"
FINER = 100.0  # from one accuracy to the next
# The root mean square of an estimate over the 13 numbers of a state keeps the tolerance. All of it
# may be in the quaternion, and an attitude is off by twice as much as its quaternion.
PER_STEP = 2.0 * math.sqrt(13.0)
FINEST = 1e-13  # 450 roundings of a double; an estimate of the error rounds as well


def finest_of(integrator: Integrator) -> float:
    """The finest accuracy that is requested of an integrator."""
    return max(FINEST, integrator.finest_accuracy)


def usual_for(integrator: Integrator) -> float | None:
    """The accuracy of an integrator that is run at one alone; None where it is run in steps."""
    if integrator.knob != "accuracy":
        return None
    return max(ACCURACIES[-1], integrator.finest_accuracy)


def tolerated_by(integrator: Integrator) -> Tolerated:
    """What steps of the finest accuracy may be off; nothing where there is no accuracy.

    A run so short that it is one step may be off by `PER_STEP` accuracies.
    """
    known = integrator.knob == "accuracy" or integrator.finest_accuracy
    if integrator.knob == "timestep" or not known:
        return Tolerated()
    accuracy = finest_of(integrator)
    return Tolerated(PER_STEP * accuracy, accuracy * steps_per_radian(integrator, accuracy))


@dataclass(frozen=True)
class AccuracyRun(MeasuredRun):
    """A measured run of an error-controlled integrator.

    kept: (n,) by channel, what is off where each step (`steps_of`) adds `PER_STEP` accuracies.
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


def per_sample(integrator: Integrator) -> int:
    """The most steps from one sample to the next where errors do not follow the accuracy by its
    power, for all steps end at samples.

    A step that the tolerance does not shorten is the whole interval, at every accuracy. Errors
    are proportional to ``h^p``. Where an accuracy finer by a factor r makes them smaller by less
    than ``r^(1/2)``, steps have become shorter by less than ``r^(1/(2p))``.
    """
    return math.ceil(math.pow(FINER, 0.5 / order_of(integrator)))


def steps_of(truth: Truth, integrator: Integrator, sweep: Sweep) -> Array:
    """(n,): about the steps up to each sample, one a radian or `per_sample` where these are more.

    Each keeps the tolerance by itself, so the run may be off by so many tolerances.
    """
    between_samples = per_sample(integrator) * np.arange(len(sweep.times), dtype=float)
    steps: Array = np.maximum(1.0 + pace(truth) * sweep.times, between_samples)
    return steps


def measure_accuracy(
    truth: Truth, integrator: Integrator, sweep: Sweep, state: State
) -> AccuracyRun:
    """As `measure`, with the rounding of the integrator's own steps."""
    truth = truth.of_kept(sweep, state)
    measured = measure(truth, sweep, state, None)
    assert sweep.accuracy is not None
    yardstick, growth = truth.yardstick, truth.growth[truth.rows(sweep)]
    between = pace(truth) * sweep.timestep * steps_per_radian(integrator, sweep.accuracy)
    within = max(1.0, between)
    bound = yardstick.round_off(sweep.timestep / within, within * sweep.sample_steps, growth)
    # a velocity that is a turn over a step has no rounding without one
    length = sweep.timestep / within if yardstick.roundings.of_turns else 0.0
    rounding = yardstick.round_off(length, np.zeros(1), np.ones(1))["omega"][0]
    off = PER_STEP * sweep.accuracy * steps_of(truth, integrator, sweep)
    times = np.maximum(sweep.times, sweep.timestep)
    kept = yardstick.round_off(times / (off / rounding), off / rounding, growth)
    own = {**vars(measured), "round_off": bound}
    return AccuracyRun(**own, kept=kept)


def fixed(findings: dict[str, Finding]) -> dict[str, Finding]:
    """The findings where the accuracy cannot be set, so that no error shows a fault."""
    return {channel: _fixed(finding) for channel, finding in findings.items()}


def _fixed(finding: Finding) -> Finding:
    judged = finding.kind in ("round-off", "explained", "consistent", "beyond")
    return finding if judged or finding.note == "not finite" else Finding("beyond", FIXED)


def fixed_orders(found: Sequence[Row]) -> list[Row]:
    """The rows of observed orders where the accuracy cannot be set: a step shows no order then."""
    return [replace(r, verdict="info", note=FIXED) if r.verdict == "fail" else r for r in found]
