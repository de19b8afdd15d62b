"""The one-step defect: what a single step from an exact state does wrong."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from omegadot.diagnosis.scheme_study.orders import (
    COARSEST,
    MOST_HALVINGS,
    SAMPLES,
    Observed,
    Point,
    observe,
    sweep,
)
from omegadot.diagnosis.scheme_study.probes import Probe, truth_of
from omegadot.diagnosis.scheme_study.subject import Stepper
from omegadot.gates.bounds.measures import Yardstick
from omegadot.gates.errors.measured_run import CHANNELS
from omegadot.harness.judging.judged_run import is_finite
from omegadot.reference_impl.solutions.growth import growth_along
from omegadot.reference_impl.solutions.series import solve_series
from omegadot.reference_impl.system import State

STARTS = 5  # exact states along the trajectory that a step is taken from
# rad: one step errs by a power more than many, and meets rounding sooner
LONGEST = 2 * COARSEST
NAMED_HALVINGS = 3
NAMED = LONGEST / 2**NAMED_HALVINGS  # rad: the step whose defect is shown


@dataclass(frozen=True)
class Defect:
    """The root mean square of the starts' defects at the named step, and its order in the step.

    value: None where that step blew up.  observed: "floor" where it is rounding alone.
    """

    value: float | None
    observed: Observed


@dataclass(frozen=True, eq=False)
class Leap:
    """An exact state and the exact states one step later, the coarsest step first."""

    start: State
    ends: tuple[State, ...]
    growth: float


@cache
def _leaps(probe: Probe) -> tuple[Yardstick, tuple[Leap, ...]]:
    longest = probe.timestep(LONGEST)
    instants = probe.timestep(COARSEST) * np.arange(SAMPLES + 1)
    measured = truth_of(probe, tuple(instants.tolist()))
    spans = np.append(longest / 2.0 ** np.arange(MOST_HALVINGS + 1), 0.0)
    leaps = []
    for row in range(0, SAMPLES, SAMPLES // STARTS):
        start = measured.state[row]
        states = solve_series(probe.system, start, spans)
        ends = tuple(states[[-1, n]] for n in range(MOST_HALVINGS + 1))
        times = np.array([0.0, longest])
        growth = growth_along(probe.system, times, ends[0], measured.yardstick.rate)
        leaps.append(Leap(start, ends, float(growth[-1])))
    return measured.yardstick, tuple(leaps)


def defects(probe: Probe, step: Stepper) -> dict[str, Defect]:
    """The one-step defect per channel. Its order is one more than that of what accumulates.

    Raises NoAnswerError.
    """
    yardstick, leaps = _leaps(probe)
    longest = probe.timestep(LONGEST)

    def measure(halvings: int) -> dict[str, Point] | None:
        timestep = longest / 2**halvings
        squares = dict.fromkeys(CHANNELS, 0.0)
        for leap in leaps:
            end = step(leap.start, timestep, 1, 1)
            if not is_finite(end):
                return None
            for channel in CHANNELS:
                error = yardstick.distance(channel, end, leap.ends[halvings])[-1]
                squares[channel] += float(error) ** 2 / len(leaps)
        # The largest growth bounds them all, hence their mean too.
        growth = np.array([1.0, max(leap.growth for leap in leaps)])
        bound = yardstick.round_off(timestep, np.array([0, 1]), growth)
        return {
            channel: Point(timestep, float(np.sqrt(square)), float(bound[channel][-1]))
            for channel, square in squares.items()
        }

    found, named = {}, longest / 2**NAMED_HALVINGS
    for channel, points in sweep(measure).items():
        value = next((point.error for point in points if point.timestep == named), None)
        found[channel] = Defect(value, observe(points))
    return found
