"""Name the schemes that an integrator's steps equal to rounding, whatever it declares."""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from omegadot.diagnosis.scheme_study.probes import Probe, truth_of
from omegadot.diagnosis.scheme_study.subject import Stepper
from omegadot.gates.errors.measured_run import CHANNELS
from omegadot.gates.truth import SchemeKey
from omegadot.harness.judging.judged_run import is_finite
from omegadot.reference_impl.coordinates import Coordinates, distinct
from omegadot.reference_impl.schemes import COMMON, SCHEMES, Scheme
from omegadot.reference_impl.solutions.companion import CompanionRun, Steps, companion
from omegadot.reference_impl.system import State

# Angles r a step. At 0.2 rad the schemes of order 4 differ most among each other. Below 1e-3 rad an
# engine may expand the turn to second order: at 2e-4 rad the r^3/6 that it is then too long stands
# clear of rounding, while the r^4/4 that the matrix is off orthogonal, which each engine mends
# in coordinates of its own, does not.
WEEDING = ((0.2, 60, 20), (0.02, 60, 20), (2e-4, 60, 20))
# What is left is followed over three turns.
FOLLOWING = ((0.02, 1000, 20),)
Lanes = tuple[tuple[float, int, int], ...]


@dataclass(frozen=True)
class Match:
    """A scheme that an integrator equals to rounding on one probe.

    residual: the largest distance in attitude (rad) and omega (relative).  share: the largest part
    of the bound that was used, over all channels; at most one.  steps: of the longest run.
    """

    scheme: str
    coordinates: Coordinates
    residual: float
    share: float
    steps: int

    @property
    def key(self) -> SchemeKey:
        """Scheme and coordinates stepped."""
        return SchemeKey(self.scheme, self.coordinates)


def _keys_of(probe: Probe, schemes: Mapping[str, Scheme]) -> list[SchemeKey]:
    """The schemes in all coordinates in which each is another computation."""
    ways = distinct(probe.system)
    return [
        SchemeKey(name, way)
        for name, scheme in schemes.items()
        for way in ways
        if way in scheme.coordinates
    ]


_computing = threading.Lock()  # engines are studied side by side and share what is computed here


@cache
def _computed(probe: Probe, key: SchemeKey, lanes: Lanes) -> list[CompanionRun]:
    plan = _plan(probe, lanes)
    rate = truth_of(probe, tuple(plan[0].times.tolist())).yardstick.rate
    return companion(probe.system, probe.initial, key.scheme, rate, plan, key.coordinates)


def _plan(probe: Probe, lanes: Lanes) -> list[Steps]:
    return [Steps(probe.timestep(angle), steps, every) for angle, steps, every in lanes]


def _compare(
    probe: Probe, key: SchemeKey, lanes: Lanes, measured_runs: Sequence[State]
) -> tuple[float, float]:
    """Largest residual, and largest share of the round-off bound: above one, they differ.

    The bound is `Yardstick.round_off` with the growth along the scheme's own trajectory. Where that
    trajectory blows up there is no bound, hence no match. An equation that engines solve less
    finely than to rounding widens it in proportion.
    """
    widened = 1 + SCHEMES[key.scheme].solved_to / float(np.finfo(float).eps)
    with _computing:
        runs = _computed(probe, key, lanes)
    residual = share = 0.0
    for step, run, measured in zip(_plan(probe, lanes), runs, measured_runs, strict=True):
        if not (np.all(np.isfinite(run.growth)) and is_finite(measured) and is_finite(run.state)):
            return np.inf, np.inf
        yardstick = truth_of(probe, tuple(step.times.tolist())).yardstick
        bound = yardstick.round_off(step.timestep, step.sample_steps, run.growth)
        for channel in CHANNELS:
            distance = yardstick.distance(channel, measured, run.state)
            share = max(share, float(np.max(distance / (widened * bound[channel]))))
            if channel in ("omega", "attitude"):
                residual = max(residual, float(np.max(distance)))
    return residual, share


def _measured_runs(probe: Probe, step: Stepper, lanes: Lanes) -> list[State]:
    return [step(probe.initial, s.timestep, s.steps, s.every) for s in _plan(probe, lanes)]


def fingerprint(probe: Probe, step: Stepper) -> list[Match]:
    """The schemes that `step` equals on a probe, the simplest first; none where it is unknown.

    The reference's schemes are stepped at the same three step sizes, those on charts of one engine
    where no common one agrees to round-off. What agrees is followed over a longer run. Raises
    NoAnswerError.
    """
    measured_runs = _measured_runs(probe, step, WEEDING)

    def agreeing(schemes: Mapping[str, Scheme]) -> list[SchemeKey]:
        keys = _keys_of(probe, schemes)
        return [key for key in keys if _compare(probe, key, WEEDING, measured_runs)[1] <= 1.0]

    others = {name: one for name, one in SCHEMES.items() if name not in COMMON}
    left = agreeing(COMMON) or agreeing(others)
    if not left:
        return []
    longer, found = _measured_runs(probe, step, FOLLOWING), []
    for key in left:
        residual, share = _compare(probe, key, FOLLOWING, longer)
        if share <= 1.0:
            steps = max(count for _, count, _ in FOLLOWING)
            found.append(Match(key.scheme, key.coordinates, residual, share, steps))
    return found
