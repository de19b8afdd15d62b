"""Faults of the stepping: the equation is right, and what is made of it is not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.adapters.protocol import Trajectory
from omegadot.commands.faults.catalogue.load import ExtraTorque
from omegadot.commands.faults.fault import Spoiled, fault
from omegadot.commands.faults.restepped import Restepped
from omegadot.diagnosis import step_ends
from omegadot.gates.scales import norm
from omegadot.harness.random_cases import FASTEST, SLEEPY
from omegadot.reference_impl.energy import total_energy
from omegadot.reference_impl.momentum import angular_momentum
from omegadot.reference_impl.motion import AccelerationOf
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.schemes import SCHEMES, Scheme
from omegadot.reference_impl.system import Acceleration, Array, State

SECRET_DAMPING = 1e-4  # N m s/rad


@fault("stepping", "scheme")
class SecretDamping(ExtraTorque):
    """A damping of 1e-4 N m s/rad that was not requested acts in the steps."""

    def torque(self, state: State) -> Array:
        """Against omega."""
        return -SECRET_DAMPING * state.angular_velocity

    def forward_dynamics(self, states: State) -> Acceleration:
        """Sound when queried."""
        return self.inner.forward_dynamics(states)


class StepEnds(Restepped):
    """Every step ends in a state that `end` makes of the right one."""

    def end(self, before: State, after: State, dt: float | Array) -> State:
        """The wrong state."""
        return after

    def scheme(self, declared: Scheme) -> Scheme:
        """The declared scheme with the wrong ends."""
        return step_ends.with_end(declared, self.end)


@fault("stepping", "scheme")
class AttitudeLeftMultiplied(StepEnds):
    """The attitude's change in body axes is multiplied from the left."""

    def end(self, before: State, after: State, dt: float | Array) -> State:
        """The change from the left."""
        return step_ends.left_multiplied(before, after, dt)


@fault("stepping", "scheme")
class QuaternionDrifts(StepEnds):
    """The attitude is stepped as ``q + h/2 q omega`` and never normalised."""

    def end(self, before: State, after: State, dt: float | Array) -> State:
        """A straight step of the quaternion."""
        return step_ends.straight_quaternion(before, after, dt)

    def acceleration(self) -> AccelerationOf:
        """Evaluated at the unit quaternion of the same direction, as engines do."""
        sound = self.sound_acceleration()
        return lambda state: sound(replace(state, orientation=normalize(state.orientation)))


@fault("stepping", "scheme", "order-4")
class AttitudeByLastOmega(StepEnds):
    """The attitude turns by the step's last omega, whatever the scheme made of omega."""

    def end(self, before: State, after: State, dt: float | Array) -> State:
        """The exponential of the end's omega."""
        return step_ends.turned_by_last_omega(before, after, dt)


@fault("stepping", "scheme")
class SinglePrecision(StepEnds):
    """The state is kept in single precision."""

    def end(self, before: State, after: State, dt: float | Array) -> State:
        """Rounded."""
        return step_ends.single_precision(before, after, dt)


@fault("stepping", "scheme", "slow")
class FallsAsleep(StepEnds):
    """Below 0.05 rad/s the body is put to rest."""

    def end(self, before: State, after: State, dt: float | Array) -> State:
        """At rest."""
        return step_ends.asleep_below(SLEEPY)(before, after, dt)


@fault("stepping", "scheme", "fast")
class OmegaClamped(StepEnds):
    """omega is held below 1 rad/s."""

    def end(self, before: State, after: State, dt: float | Array) -> State:
        """No faster than the limit."""
        return step_ends.held_below(FASTEST)(before, after, dt)


@fault("stepping", "scheme", "torque-free")
class EnergyCorrected(Spoiled):
    """omega is rescaled so that the kinetic energy of rotation looks conserved."""

    def logged(self, trajectory: Trajectory) -> Trajectory:
        """Every sample has the energy of the first."""
        state = trajectory.state
        still = replace(state, linear_velocity=np.zeros_like(state.linear_velocity))
        no_gravity = replace(self.system, load=replace(self.system.load, gravity=np.zeros(3)))
        energy = total_energy(no_gravity, still)
        w = state.angular_velocity * np.sqrt(energy[0] / energy)[:, None]
        return Trajectory(trajectory.time, replace(state, angular_velocity=w))


@fault("stepping", "scheme", "torque-free")
class MomentumCorrected(Spoiled):
    """omega is rescaled so that the size of the angular momentum looks conserved."""

    def logged(self, trajectory: Trajectory) -> Trajectory:
        """Every sample has the momentum of the first."""
        state = trajectory.state
        size = norm(angular_momentum(self.system, state))
        w = state.angular_velocity * (size[0] / size)[:, None]
        return Trajectory(trajectory.time, replace(state, angular_velocity=w))


@fault("stepping", "scheme")
class StepSlightlyLong(Spoiled):
    """Steps are 0.1 % longer than requested."""

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """As requested, with a longer step under the same times."""
        found = super().run(initial, integrator, 1.001 * timestep, steps, every)
        return Trajectory(found.time / 1.001, found.state)


@fault("stepping", "scheme", "order-4")
class EulerAsRungeKutta(Restepped):
    """Runge-Kutta of order 4 is declared, and semi-implicit Euler is stepped."""

    def scheme(self, declared: Scheme) -> Scheme:
        """Euler."""
        return SCHEMES["semi-implicit-euler"]


@fault("stepping", "scheme", "order-4")
class AttitudeOfOrderTwo(Restepped):
    """The attitude is of order 2 under a declared 4: the stages' rotations do not commute."""

    def scheme(self, declared: Scheme) -> Scheme:
        """The mean of omega in one exponential."""
        return SCHEMES["lie-rk4-naive"] if declared.orders["attitude"] == 4 else declared
