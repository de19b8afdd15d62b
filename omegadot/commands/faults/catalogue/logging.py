"""Faults of logging and of memory: the motion is right, and the record or the start is not."""

# ruff: noqa: D403  (omega is a symbol)

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from omegadot.adapters.protocol import Trajectory
from omegadot.commands.faults.fault import Spoiled, fault, fault_by, logged
from omegadot.reference_impl.stepping import kept_steps
from omegadot.reference_impl.system import Array, State, System

Run = Callable[[State, float, int, int], Trajectory]
"""A run by one integrator: of the initial state, the step in s, the steps, and those a sample."""


class OtherRun(Spoiled):
    """A run is what `made` makes of the sound engine's."""

    made: Callable[[Run, State, float, int, int], Trajectory]

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """As `Adapter.run`, made wrong."""
        sound = super().run

        def run(initial: State, h: float, steps: int, every: int) -> Trajectory:
            return sound(initial, integrator, h, steps, every)

        return self.made(run, initial, timestep, steps, every)


other_run = partial(fault_by, OtherRun, "made")
loaded = partial(fault_by, Spoiled, "loaded", "state")


def rows(state: State, which: NDArray[np.intp] | slice) -> State:
    """Some samples of a run."""
    return State(*(values[which] for values in vars(state).values()))


def half_a_step_back(values: Array, rate: Array, timestep: float) -> Array:
    """Samples (n, 3), all but the first, taken back by half a step at their rate."""
    taken = values.copy()
    taken[1:] -= 0.5 * timestep * rate[1:]
    return taken


@logged("logging", "trajectory", named="the first sample is missing")
def FirstSampleMissing(self: Spoiled, trajectory: Trajectory) -> Trajectory:
    """The first sample is missing."""
    return Trajectory(trajectory.time[1:], rows(trajectory.state, slice(1, None)))


@other_run("logging", "scheme", named="the last step is missing")
def LastStepMissing(run: Run, initial: State, h: float, steps: int, every: int) -> Trajectory:
    """The last step is not taken: the end is reported as it was a step before."""
    found = run(initial, h, steps, every)
    short = run(initial, h, steps - 1, every)
    old = zip(vars(found.state).values(), vars(short.state).values(), strict=True)
    return Trajectory(found.time, State(*(np.vstack([a[:-1], b[-1:]]) for a, b in old)))


@other_run("logging", "scheme", named=("logged one step late", "logged one sample late"))
def LogsOneStepLate(run: Run, initial: State, h: float, steps: int, every: int) -> Trajectory:
    """Every sample after the first is the state one step before."""
    found = run(initial, h, steps, 1)
    kept = np.array(kept_steps(steps, every))
    return Trajectory(kept * h, rows(found.state, np.maximum(kept - 1, 0)))


@logged("logging", "scheme", named="logged one sample late")
def LogsOneSampleLate(self: Spoiled, trajectory: Trajectory) -> Trajectory:
    """Every sample after the first is the one before."""
    late = np.maximum(np.arange(len(trajectory.time)) - 1, 0)
    return Trajectory(trajectory.time, rows(trajectory.state, late))


@other_run("logging", "trajectory", named="s late, 1 steps")
def TimesShifted(run: Run, initial: State, h: float, steps: int, every: int) -> Trajectory:
    """Times are reported at the end of the step after."""
    found = run(initial, h, steps, every)
    return Trajectory(found.time + h, found.state)


@logged("logging", "trajectory", named="angular velocity: not finite")
def NotFiniteAfterAWhile(self: Spoiled, trajectory: Trajectory) -> Trajectory:
    """omega is NaN in the second half of a run."""
    w = trajectory.state.angular_velocity.copy()
    w[len(w) // 2 :] = np.nan
    return Trajectory(trajectory.time, replace(trajectory.state, angular_velocity=w))


@fault("state", "scheme", named="left over from a run before")
class StaleState(Spoiled):
    """A run begins where the last one ended, whatever state it is given."""

    _last: State | None = None

    def load(self, system: System) -> None:
        """A new system has no last run."""
        self._last = None
        super().load(system)

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """From the end of the last run."""
        start = initial if self._last is None else self._last
        found = super().run(start, integrator, timestep, steps, every)
        self._last = State(*(values[-1] for values in vars(found.state).values()))
        return found


@loaded("model", named="those of another inertia")
def LeaksBetweenScenarios(self: Spoiled, system: System) -> System:
    """A tenth of a percent of the last scenario's inertia is left in the next one's."""
    if self._system is None:
        return system
    tensor = 0.999 * system.body.inertia + 0.001 * self._system.body.inertia
    return replace(system, bodies=(replace(system.body, inertia=tensor),))


@loaded("equation", "gravity", named=("gravity is (", "gravity is missing"))
def GravityOfTheLastScenario(self: Spoiled, system: System) -> System:
    """Gravity stays what it was in the scenario before."""
    before = self._system or system
    return replace(system, load=replace(system.load, gravity=before.load.gravity))
