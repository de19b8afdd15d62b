"""One run as it was reported, next to the same run stepped by the reference."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.explicit_schemes import scheme_named
from omegadot.gates.case import Case, Sweep
from omegadot.gates.errors.measured_run import CHANNELS
from omegadot.gates.truth import Truth
from omegadot.harness.drive import CaseResult
from omegadot.harness.judging.judged_run import JudgedRun
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.schemes import SCHEMES, Scheme
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, State, System

LEAST_SAMPLES = 6
# In parts of what rounding may do: a fitted number is then good to six digits.
DISTINCT = 1e6
SLACK = 4.0


@dataclass(frozen=True)
class ReportedRun:
    """time and state as reported; own: the reference's run of the declared scheme at the samples.

    growth: (n,), how far rounding may have grown along it.  is_declared: False where the scheme is
    a guess, and one of the nearest.
    """

    case: Case
    truth: Truth
    integrator: Integrator
    sweep: Sweep
    time: Array
    state: State
    own: State
    growth: Array
    is_declared: bool = True

    @property
    def declared(self) -> Scheme:
        """The scheme that is declared, or the guess."""
        return scheme_named(self.integrator.scheme or "")

    @property
    def bounds(self) -> dict[str, Array]:
        """(n,) per channel: what rounding may account for."""
        step, numbers = self.sweep.timestep, self.sweep.sample_steps
        return self.truth.yardstick.round_off(step, numbers, self.growth)

    def agrees(
        self, state: State, other: State, samples: slice = slice(None), slack: float = 1.0
    ) -> bool:
        """Whether two trajectories are the same within rounding, at these samples."""
        bounds, yardstick = self.bounds, self.truth.yardstick
        return all(
            bool(np.all(yardstick.distance(c, state, other) <= slack * bounds[c][samples]))
            for c in CHANNELS
        )

    @property
    def is_own(self) -> bool:
        """Whether the whole run is the reference's."""
        return len(self.time) == len(self.own.position) and self.agrees(self.state, self.own)

    @property
    def distance_at_first(self) -> tuple[bool, int, float]:
        """Whether the first interval is off, how many quantities are soon, and how far in bounds.

        A run of one scheme in which one quantity is misreported is nearer to it than to others, and
        one that is led astray later begins as it does.
        """
        bounds, first = self.bounds, slice(1, LEAST_SAMPLES)
        shares = [
            self.truth.yardstick.distance(c, self.state[first], self.own[first]) / bounds[c][first]
            for c in CHANNELS
        ]
        off = sum(not bool(np.all(one <= SLACK)) for one in shares)
        begins = all(bool(np.all(one[:1] <= SLACK)) for one in shares)
        return not begins, off, float(np.nan_to_num(np.median(np.max(shares, axis=0)), nan=np.inf))

    def stepped(
        self,
        scheme: Scheme | None = None,
        system: System | None = None,
        initial: State | None = None,
        timestep: float | None = None,
        every_step: bool = False,
    ) -> State:
        """The reference's run with something else in it; the declared where nothing is given."""
        wanted, sweep = system or self.case.system, self.sweep
        exact = body_motion(wanted, self.integrator.coordinates)
        plan = (timestep or sweep.timestep, sweep.steps, 1 if every_step else sweep.every)

        def acceleration(q: Array, v: Array) -> Array:  # a wrong end may leave q too long
            return exact.acceleration(exact.normalize(q), v)

        how = (*plan, self.integrator.coordinates, replace(exact, acceleration=acceleration))
        return step_body(scheme or self.declared, wanted, initial or self.case.initial, *how)[1]

    @cached_property
    def beginning(self) -> ReportedRun:
        """Up to the first sample at which it is not the reference's: what this rules out is out."""
        count = len(self.time)
        for k in range(1, count):
            here = slice(k, k + 1)
            if not self.agrees(self.state[here], self.own[here], here):
                return self.until(k + 1)
        return self

    def until(self, count: int) -> ReportedRun:
        """Its first samples."""
        if count >= len(self.time):
            return self
        first = {name: getattr(self, name)[:count] for name in ("time", "state", "own", "growth")}
        return replace(self, sweep=self.sweep.until(count), **first)

    def is_made(self, made: Callable[[ReportedRun], State], slack: float = 1.0) -> bool:
        """Whether this is how the run is made: in its first samples, then in more of it.

        Most ways are ruled out by the first, which are stepped in no time.
        """
        parts = {len(one.time): one for one in (self.until(LEAST_SAMPLES), self.beginning, self)}
        return all(
            one.agrees(one.state, made(one), slack=slack) for _, one in sorted(parts.items())
        )

    def stepped_on(self, states: State, steps: int | None = None) -> State:
        """Where the declared scheme leads from each of (m,) states to the next sample.

        steps: that many on, where given.
        """
        count = steps or self.sweep.every
        plan = (self.sweep.timestep, count, count)
        unit = replace(states, orientation=normalize(states.orientation))
        how = (*plan, self.integrator.coordinates)
        return step_body(self.declared, self.case.system, unit, *how)[1][-1]


def reported_run(
    case: Case, truth: Truth, result: CaseResult, run: JudgedRun
) -> ReportedRun | None:
    """The run that was judged; None where it failed or no scheme is declared for it."""
    integrator, sweep = run.integrator, run.sweep
    answer = result.runs.get((integrator.name, sweep.timestep))
    own = truth.companion(integrator, sweep)
    if answer is None or not answer.ok or own is None or integrator.scheme not in SCHEMES:
        return None
    time, state = answer.result["time"], State(**answer.result["state"])
    whole = ReportedRun(case, truth, integrator, sweep, time, state, own.state, own.growth)
    return until_it_shows(whole) if len(time) == len(sweep.times) else whole


def until_it_shows(reported: ReportedRun) -> ReportedRun:
    """The beginning of a run, until it has departed from the reference's beyond any doubt.

    Causes are tried by stepping again: a short trajectory is quicker, and followed more surely
    where the motion magnifies what is not quite right yet.
    """
    bounds = reported.bounds
    distances = {
        c: reported.truth.yardstick.distance(c, reported.state, reported.own) for c in CHANNELS
    }
    apart = np.any([~(distances[c] <= DISTINCT * bounds[c]) for c in CHANNELS], axis=0)
    first = int(np.argmax(apart)) if apart.any() else len(apart)
    return reported.until(min(max(2 * first, LEAST_SAMPLES), len(apart)))
