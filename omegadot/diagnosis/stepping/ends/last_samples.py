"""The last two samples of runs, and whether steps of a scheme lead from the one to the other."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from omegadot.diagnosis.stepping.kept_run import (
    CHANNELS,
    MOST_STEPS,
    SLACK,
    SchemeOf,
    bounds_of_samples,
)
from omegadot.gates.bounds.scales import norm
from omegadot.gates.case import Sweep
from omegadot.gates.truth import Truth
from omegadot.reference_impl.rotations import normalize, rotation_between
from omegadot.reference_impl.schemes.scheme import Scheme
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, State, System

LEAST = 3  # runs, of two scenarios at least, whose last sample is another step's


@dataclass(frozen=True)
class RunEnd:
    """The last two samples of a run (2, ...), with as many steps between them.

    bounds: per channel, what rounding may do there.  fails: whether the run fails a gate.
    """

    name: str
    system: System
    sweep: Sweep
    state: State
    steps: int
    bounds: dict[str, float]
    fails: bool

    @property
    def is_short(self) -> bool:
        """Whether its last interval is shorter than the others."""
        return self.steps < self.sweep.every

    def is_after(self, by: SchemeOf, steps: int, of: Sequence[str] = CHANNELS) -> bool:
        """Whether so many steps of the scheme lead from the sample before to the last.

        Below none they lead from the last to the one before.  of: what of the state is compared.
        """
        start, came = (self.state[:1], self.state[1:])[:: -1 if steps < 0 else 1]
        return self._near(came, self._stepped(_unit(start), by, by.scheme, abs(steps)), of)

    def ends_by(self, by: SchemeOf, last: Scheme) -> bool:
        """Whether the steps lead to the last sample of which the last is by another scheme."""
        found = self._stepped(_unit(self.state[:1]), by, by.scheme, self.steps - 1)
        return self._near(self.state[1:], self._stepped(found, by, last, 1), CHANNELS)

    def _stepped(self, start: State, by: SchemeOf, scheme: Scheme, count: int) -> State:
        plan = (self.sweep.timestep, count, max(count, 1), by.coordinates)
        return step_body(scheme, self.system, start, *plan)[1][-1]

    def _near(self, came: State, found: State, of: Sequence[str]) -> bool:
        apart = {
            "omega": came.angular_velocity - found.angular_velocity,
            "attitude": rotation_between(found.orientation, came.orientation),
            "velocity": came.linear_velocity - found.linear_velocity,
            "position": came.position - found.position,
        }
        return all(bool(norm(apart[c])[0] <= SLACK * self.bounds[c]) for c in of)


def _unit(state: State) -> State:
    return replace(state, orientation=normalize(state.orientation))


def run_end(
    name: str, truth: Truth, sweep: Sweep, state: State, growth: Array, fails: bool
) -> RunEnd | None:
    """None where a sample is not finite, or too many steps lie between the two."""
    numbers, last = sweep.sample_steps, slice(-2, None)
    finite = all(bool(np.isfinite(f[last]).all()) for f in vars(state).values())
    if sweep.accuracy is not None or len(numbers) < 2 or not finite:
        return None
    steps = int(numbers[-1] - numbers[-2])
    if steps > MOST_STEPS:
        return None
    each = bounds_of_samples(truth, sweep, growth, last)
    bounds = {channel: float(values[-1]) for channel, values in each.items()}
    kept = State(*(np.array(f[last]) for f in vars(state).values()))
    return RunEnd(name, truth.yardstick.system, sweep, kept, steps, bounds, fails)


def scenarios_that_show(
    ends: Sequence[RunEnd], by: SchemeOf, fits: Callable[[RunEnd], bool]
) -> set[str]:
    """Those with a last sample that fits, and that steps by the scheme do not lead to.

    None where the last sample of one run does not fit, or too few show it.
    """
    names, count = set[str](), 0
    # of the runs that fail those of few steps rule most out
    for end in sorted(ends, key=lambda one: (not one.fails, one.steps)):
        if not fits(end):
            return set()
        if not end.is_after(by, end.steps):
            names.add(end.name)
            count += 1
    return names if count >= LEAST and len(names) > 1 else set()
