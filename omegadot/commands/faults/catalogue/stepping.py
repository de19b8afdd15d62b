"""Faults of the stepping: the equation is right, and what is made of it is not."""

# ruff: noqa: D403  (omega is a symbol)

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from omegadot.adapters.protocol import Trajectory
from omegadot.commands.faults.catalogue.load import ExtraTorque
from omegadot.commands.faults.catalogue.logging import Run, other_run
from omegadot.commands.faults.fault import Spoiled, fault_by, logged
from omegadot.commands.faults.restepped import Restepped
from omegadot.diagnosis.stepping import step_ends
from omegadot.gates.bounds.scales import norm
from omegadot.harness.random_cases import FASTEST, SLEEPY
from omegadot.reference_impl.energy import total_energy
from omegadot.reference_impl.momentum import angular_momentum
from omegadot.reference_impl.motion import AccelerationOf
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.schemes import SCHEMES, Scheme
from omegadot.reference_impl.system import Acceleration, Array, State, System

SECRET_DAMPING = 1e-4  # N m s/rad


class SecretTorque(ExtraTorque):
    """A torque that acts in the steps alone."""

    is_in_dynamics = False

    def forward_dynamics(self, states: State) -> Acceleration:
        """Sound when queried."""
        return self.inner.forward_dynamics(states)


@fault_by(
    SecretTorque,
    "torque",
    "stepping",
    "scheme",
    named=("a damping of 0.0001", "the damping that acts is"),
)
def SecretDamping(system: System, state: State) -> Array:
    """A damping of 1e-4 N m s/rad that was not requested acts in the steps."""
    return -SECRET_DAMPING * state.angular_velocity


class StepEnds(Restepped):
    """Every step ends in a state that `end` makes of the right one."""

    end: step_ends.End

    def scheme(self, declared: Scheme) -> Scheme:
        """The declared scheme with the wrong ends."""
        return step_ends.with_end(declared, self.end)


class LongStepEnds(StepEnds):
    """Every step ends in a state whose quaternion may not be of unit length."""

    def acceleration(self) -> AccelerationOf:
        """Evaluated at the unit quaternion of the same direction, as engines do."""
        sound = self.sound_acceleration()
        return lambda state: sound(replace(state, orientation=normalize(state.orientation)))


step_end = partial(fault_by, StepEnds, "end", "stepping")
long_step_end = partial(fault_by, LongStepEnds, "end", "stepping")
otherwise_stepped = partial(fault_by, Restepped, "scheme", "stepping", "scheme", "order-4")


@step_end("scheme", named="multiplied from the left")
def AttitudeLeftMultiplied(before: State, after: State, dt: float | Array) -> State:
    """The attitude's change in body axes is multiplied from the left."""
    return step_ends.left_multiplied(before, after, dt)


@long_step_end("scheme", named="q + h/2 q omega and not normalised")
def QuaternionDrifts(before: State, after: State, dt: float | Array) -> State:
    """The attitude is stepped as ``q + h/2 q omega`` and never normalised."""
    return step_ends.straight_quaternion(before, after, dt)


@step_end("scheme", "order-4", named="the attitude turns by the step's last omega")
def AttitudeByLastOmega(before: State, after: State, dt: float | Array) -> State:
    """The attitude turns by the step's last omega, whatever the scheme made of omega."""
    return step_ends.turned_by_last_omega(before, after, dt)


@step_end("scheme", named="single precision")
def SinglePrecision(before: State, after: State, dt: float | Array) -> State:
    """The state is kept in single precision."""
    return step_ends.single_precision(before, after, dt)


@step_end("scheme", "slow", named="the body is put to sleep")
def FallsAsleep(before: State, after: State, dt: float | Array) -> State:
    """Below 0.05 rad/s the body is put to rest."""
    return step_ends.asleep_below(SLEEPY)(before, after, dt)


@step_end("scheme", "fast", named="omega is held below 1 rad/s")
def OmegaClamped(before: State, after: State, dt: float | Array) -> State:
    """omega is held below 1 rad/s."""
    return step_ends.held_below(FASTEST)(before, after, dt)


@logged("stepping", "scheme", "torque-free tumbling", named="rescaled so that the kinetic energy")
def EnergyCorrected(self: Spoiled, trajectory: Trajectory) -> Trajectory:
    """omega is rescaled so that the kinetic energy of rotation looks conserved."""
    state = trajectory.state
    still = replace(state, linear_velocity=np.zeros_like(state.linear_velocity))
    no_gravity = replace(self.system, load=replace(self.system.load, gravity=np.zeros(3)))
    energy = total_energy(no_gravity, still)
    w = state.angular_velocity * np.sqrt(energy[0] / energy)[:, None]
    return Trajectory(trajectory.time, replace(state, angular_velocity=w))


@logged("stepping", "scheme", "torque-free tumbling", named="rescaled so that the angular momentum")
def MomentumCorrected(self: Spoiled, trajectory: Trajectory) -> Trajectory:
    """omega is rescaled so that the size of the angular momentum looks conserved."""
    state = trajectory.state
    size = norm(angular_momentum(self.system, state))
    w = state.angular_velocity * (size[0] / size)[:, None]
    return Trajectory(trajectory.time, replace(state, angular_velocity=w))


@other_run("stepping", "scheme", named="steps are 0.1 % too long")
def StepSlightlyLong(run: Run, initial: State, h: float, steps: int, every: int) -> Trajectory:
    """Steps are 0.1 % longer than requested."""
    found = run(initial, 1.001 * h, steps, every)
    return Trajectory(found.time / 1.001, found.state)


@otherwise_stepped(named="it is stepped by semi-implicit-euler")
def EulerAsRungeKutta(self: Restepped, declared: Scheme) -> Scheme:
    """Runge-Kutta of order 4 is declared, and semi-implicit Euler is stepped."""
    return SCHEMES["semi-implicit-euler"]


@otherwise_stepped(named="it is stepped by lie-rk4-naive")
def AttitudeOfOrderTwo(self: Restepped, declared: Scheme) -> Scheme:
    """The attitude is of order 2 under a declared 4: the stages' rotations do not commute."""
    return SCHEMES["lie-rk4-naive"] if declared.orders["attitude"] == 4 else declared
