"""Faults in which sample is reported: that of a step before, of two, one summed up or repeated."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.adapters.protocol import Trajectory
from omegadot.commands.faults.catalogue.logging import Run, half_a_step_back, other_run, rows
from omegadot.commands.faults.fault import Spoiled, fault
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.stepping import kept_steps
from omegadot.reference_impl.system import State


def _of_step_before(run: Run, initial: State, h: float, steps: int, every: int) -> State:
    """The states one step before each sample; of the start itself."""
    kept = np.array(kept_steps(steps, every))
    return rows(run(initial, h, steps, 1).state, np.maximum(kept - 1, 0))


@other_run("logging", "scheme", named=("halfway between", "half a step before"))
def AttitudeHalfway(run: Run, initial: State, h: float, steps: int, every: int) -> Trajectory:
    """The attitude reported lies halfway between that of the step before and its own."""
    found = run(initial, h, steps, every)
    before = _of_step_before(run, initial, h, steps, every).orientation
    own = found.state.orientation
    signed = before * np.sign(np.sum(before * own, axis=-1, keepdims=True))
    return Trajectory(found.time, replace(found.state, orientation=normalize(own + signed)))


@other_run("logging", "scheme", "asymmetric", named="omega alone is reported one")
def OmegaOneStepLate(run: Run, initial: State, h: float, steps: int, every: int) -> Trajectory:
    """Omega is that of the step before; all else is of the present one."""
    found = run(initial, h, steps, every)
    late = _of_step_before(run, initial, h, steps, every).angular_velocity
    return Trajectory(found.time, replace(found.state, angular_velocity=late))


@other_run(  # under constant gravity it is that of half a step before, to rounding
    *("logging", "scheme", "gravity free order-4"),
    named=("difference quotient of the position", "velocity is reported as of half a step before"),
)
def VelocityOfTwoPlaces(run: Run, initial: State, h: float, steps: int, every: int) -> Trajectory:
    """The velocity is the change of place over the last step, but for the start."""
    found = run(initial, h, steps, every)
    before = _of_step_before(run, initial, h, steps, every)
    v = found.state.linear_velocity.copy()
    v[1:] = (found.state.position[1:] - before.position[1:]) / h
    return Trajectory(found.time, replace(found.state, linear_velocity=v))


@fault(
    *("logging", "scheme", "free gravity"),
    named="the linear velocity is reported as of half a step before",
)
class VelocityAtHalfStep(Spoiled):
    """The velocity is that of half a step before."""

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """Taken back by half a step's acceleration, but for the start."""
        found = super().run(initial, integrator, timestep, steps, every)
        rate = self.inner.forward_dynamics(found.state).linear
        v = half_a_step_back(found.state.linear_velocity, rate, timestep)
        return Trajectory(found.time, replace(found.state, linear_velocity=v))


@other_run(
    *("logging", "scheme", "pivot lever"),
    named="the position of a pivoted body is summed up from the velocity",
)
def PivotedPlaceSummedUp(run: Run, initial: State, h: float, steps: int, every: int) -> Trajectory:
    """The place of a pivoted body is summed up from its velocity, and so leaves the pivot."""
    found = run(initial, h, steps, every)
    each = run(initial, h, steps, 1).state
    moves = np.concatenate([each.position[:1], h * each.linear_velocity[1:]])
    place = np.cumsum(moves, axis=0)[np.array(kept_steps(steps, every))]
    return Trajectory(found.time, replace(found.state, position=place))


@other_run(
    *("logging", "trajectory", "short-interval"),
    named="the last sample, after an interval shorter than the others, is the one before",
)
def LastShortSampleRepeated(
    run: Run, initial: State, h: float, steps: int, every: int
) -> Trajectory:
    """The sample after a last interval that is shorter than the others repeats the one before."""
    found = run(initial, h, steps, every)
    which = np.arange(len(found.time))
    which[-1] -= bool(steps % every)
    return Trajectory(found.time, rows(found.state, which))
