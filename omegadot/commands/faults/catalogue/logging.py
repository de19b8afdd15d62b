"""Faults of logging and of memory: the motion is right, and the record or the start is not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from omegadot.adapters.protocol import Adapter, Trajectory
from omegadot.commands.faults.fault import Spoiled, fault
from omegadot.reference_impl.stepping import kept_steps
from omegadot.reference_impl.system import State, System


def rows(state: State, which: NDArray[np.intp] | slice) -> State:
    """Some samples of a run."""
    return State(*(values[which] for values in vars(state).values()))


@fault("logging", "trajectory")
class FirstSampleMissing(Spoiled):
    """The first sample is missing."""

    def logged(self, trajectory: Trajectory) -> Trajectory:
        """From the second on."""
        return Trajectory(trajectory.time[1:], rows(trajectory.state, slice(1, None)))


@fault("logging", "scheme")
class LastStepMissing(Spoiled):
    """The last step is not taken: the end is reported as it was a step before."""

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """The last sample from a run that is one step shorter."""
        found = super().run(initial, integrator, timestep, steps, every)
        short = super().run(initial, integrator, timestep, steps - 1, every)
        old = zip(vars(found.state).values(), vars(short.state).values(), strict=True)
        return Trajectory(found.time, State(*(np.vstack([a[:-1], b[-1:]]) for a, b in old)))


@fault("logging", "scheme")
class LogsOneStepLate(Spoiled):
    """Every sample after the first is the state one step before."""

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """Picked from a run that keeps every step."""
        found = super().run(initial, integrator, timestep, steps, 1)
        kept = np.array(kept_steps(steps, every))
        return Trajectory(kept * timestep, rows(found.state, np.maximum(kept - 1, 0)))


@fault("logging", "scheme")
class LogsOneSampleLate(Spoiled):
    """Every sample after the first is the one before."""

    def logged(self, trajectory: Trajectory) -> Trajectory:
        """Shifted by one."""
        late = np.maximum(np.arange(len(trajectory.time)) - 1, 0)
        return Trajectory(trajectory.time, rows(trajectory.state, late))


@fault("logging", "trajectory")
class TimesShifted(Spoiled):
    """Times are reported at the end of the step after."""

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """One step late on the clock."""
        found = super().run(initial, integrator, timestep, steps, every)
        return Trajectory(found.time + timestep, found.state)


@fault("logging", "trajectory")
class NotFiniteAfterAWhile(Spoiled):
    """omega is NaN in the second half of a run."""

    def logged(self, trajectory: Trajectory) -> Trajectory:
        """NaN from the middle on."""
        w = trajectory.state.angular_velocity.copy()
        w[len(w) // 2 :] = np.nan
        return Trajectory(trajectory.time, replace(trajectory.state, angular_velocity=w))


@fault("state", "scheme")
class StaleState(Spoiled):
    """A run begins where the last one ended, whatever state it is given."""

    def __init__(self, inner: Adapter) -> None:
        super().__init__(inner)
        self._last: State | None = None

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


@fault("state", "model")
class LeaksBetweenScenarios(Spoiled):
    """A tenth of a percent of the last scenario's inertia is left in the next one's."""

    def loaded(self, system: System) -> System:
        """The sum of what is requested and what is left."""
        before, self._before = getattr(self, "_before", None), system
        if before is None:
            return system
        tensor = 0.999 * system.body.inertia + 0.001 * before.body.inertia
        return replace(system, bodies=(replace(system.body, inertia=tensor),))


@fault("state", "equation", "gravity")
class GravityOfTheLastScenario(Spoiled):
    """Gravity stays what it was in the scenario before."""

    def loaded(self, system: System) -> System:
        """The last gravity."""
        before, self._before = getattr(self, "_before", system), system
        return replace(system, load=replace(system.load, gravity=before.load.gravity))
