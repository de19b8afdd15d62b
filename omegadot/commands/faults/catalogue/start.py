"""Faults of the start and of the end of a run: signs, swapped components, the last interval."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from omegadot.adapters.protocol import Trajectory
from omegadot.commands.faults.catalogue.convention import Misread, Throughout
from omegadot.commands.faults.catalogue.logging import Run, other_run
from omegadot.commands.faults.fault import Spoiled, fault, fault_by, logged
from omegadot.reference_impl.kinematics import point_position, point_velocity
from omegadot.reference_impl.stepping import kept_steps
from omegadot.reference_impl.system import State

MICRO = 1e6

# On one scenario no rule is known; over several, by which one the start is another.
BEGINS = ("does not begin at the state it is given", "a run begins with")

start = partial(other_run, "logging", "trajectory")
timed = partial(other_run, "logging", "trajectory")
misread = partial(fault_by, Misread, "reported", "convention", "scheme")


@start("scalar-negative", named=BEGINS)
def StartScalarBySize(run: Run, initial: State, h: float, steps: int, every: int) -> Trajectory:
    """A run begins with the scalar part of the quaternion taken by its size."""
    q = initial.orientation.copy()
    q[..., 0] = np.abs(q[..., 0])
    return run(replace(initial, orientation=q), h, steps, every)


@start(named=BEGINS)
def StartQuaternionYZSwapped(
    run: Run, initial: State, h: float, steps: int, every: int
) -> Trajectory:
    """A run begins with y and z of the quaternion swapped; they are equal in most scenarios."""
    q = initial.orientation[..., [0, 1, 3, 2]]
    return run(replace(initial, orientation=q), h, steps, every)


@start("free", named=BEGINS)
def StartPositionXYSwapped(
    run: Run, initial: State, h: float, steps: int, every: int
) -> Trajectory:
    """A run begins with x and y of the position swapped; they are equal in most scenarios."""
    return run(replace(initial, position=initial.position[..., [1, 0, 2]]), h, steps, every)


@misread(named=("attitude", "quaternion", "rotation"))
def QuaternionOfWrongBranch(self: Spoiled, state: State) -> State:
    """Quaternions out of matrices of negative trace have the scalar part's sign wrong."""
    q = state.orientation.copy()
    q[..., 0] *= np.where(4.0 * q[..., 0] ** 2 < 1.0, -1.0, 1.0)
    return replace(state, orientation=q)


def position_as_origins(self: Spoiled, state: State) -> State:
    """The centre of mass of a body whose origin is at the position given."""
    return replace(state, position=point_position(state, self.system.body.center_of_mass))


def origins_position(self: Spoiled, state: State) -> State:
    """The inverse."""
    return replace(state, position=point_position(state, -self.system.body.center_of_mass))


@fault("convention", "trajectory", "free offset", named=("position", "origin"))
class PositionOfOriginThroughout(Throughout):
    """Positions are the origin's, going in and coming out."""

    ways = position_as_origins, origins_position


def velocity_as_origins(self: Spoiled, state: State) -> State:
    """The centre of mass's velocity of a body whose origin has the velocity given."""
    velocity = point_velocity(state, self.system.body.center_of_mass)
    return replace(state, linear_velocity=velocity)


def origins_velocity(self: Spoiled, state: State) -> State:
    """The inverse."""
    velocity = point_velocity(state, -self.system.body.center_of_mass)
    return replace(state, linear_velocity=velocity)


@fault("convention", "trajectory", "free offset", named=("velocity", "origin"))
class VelocityOfOriginThroughout(Throughout):
    """Linear velocities are the origin's, going in and coming out."""

    ways = velocity_as_origins, origins_velocity


@timed("short-interval", named=("time", "clock"))
def LastTimeOnGrid(run: Run, initial: State, h: float, steps: int, every: int) -> Trajectory:
    """The last time is a whole interval after the one before, however short the last one is."""
    found = run(initial, h, steps, every)
    return Trajectory(h * every * np.arange(len(found.time)), found.state)


@timed("short-interval", named=("last", "late", "early", "step"))
def LastIntervalWhole(run: Run, initial: State, h: float, steps: int, every: int) -> Trajectory:
    """The last interval is stepped in full, however short it is, and its end reported on time."""
    found = run(initial, h, -(-steps // every) * every, every)
    return Trajectory(h * np.array(kept_steps(steps, every)), found.state)


@timed("fine-times", named=("clock", "time"))
def ClockInMicroseconds(run: Run, initial: State, h: float, steps: int, every: int) -> Trajectory:
    """Times are reported in whole microseconds."""
    found = run(initial, h, steps, every)
    return Trajectory(np.round(found.time * MICRO) / MICRO, found.state)


@timed("fine-steps", named=("clock", "steps are"))
def StepInMicroseconds(run: Run, initial: State, h: float, steps: int, every: int) -> Trajectory:
    """Steps are rounded to whole microseconds, and reported as requested."""
    found = run(initial, max(1.0, np.round(h * MICRO)) / MICRO, steps, every)
    return Trajectory(h * np.array(kept_steps(steps, every)), found.state)


@logged("logging", "trajectory", named=("clock", "time", "single precision"))
def ClockInSinglePrecision(self: Spoiled, trajectory: Trajectory) -> Trajectory:
    """Times are kept in single precision."""
    return Trajectory(trajectory.time.astype(np.float32).astype(float), trajectory.state)
