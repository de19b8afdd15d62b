"""Faults in what is reported of a run that is sound: half a step off, smoothed, rounded, noisy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.adapters.protocol import Trajectory
from omegadot.commands.faults.catalogue.stepping import StepEnds
from omegadot.commands.faults.fault import Spoiled, fault
from omegadot.diagnosis import step_ends
from omegadot.gates.scales import norm
from omegadot.reference_impl.motion import AccelerationOf
from omegadot.reference_impl.rotations import normalize, turn_in_body
from omegadot.reference_impl.system import Acceleration, Array, State

JITTER = 1e-9  # of omega
DRIFT = 1e-9  # of the clock
DIGITS = 9
MOST = 0.5  # rad/s, of a component


@fault("logging", "scheme")
class AttitudeAtHalfStep(Spoiled):
    """The attitude reported is that of half a step before."""

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """Turned back by half a step, but for the start."""
        found = super().run(initial, integrator, timestep, steps, every)
        back = turn_in_body(
            found.state.orientation[1:], found.state.angular_velocity[1:], -0.5 * timestep
        )
        reported = np.concatenate([found.state.orientation[:1], back])
        return Trajectory(found.time, replace(found.state, orientation=reported))


@fault("logging", "scheme", "asymmetric")
class OmegaAtHalfStep(Spoiled):
    """omega is that of half a step before."""

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """Taken back by half a step's omega-dot, but for the start."""
        found = super().run(initial, integrator, timestep, steps, every)
        w_dot = self.inner.forward_dynamics(found.state).angular.copy()
        w_dot[0] = 0.0
        w = found.state.angular_velocity - 0.5 * timestep * w_dot
        return Trajectory(found.time, replace(found.state, angular_velocity=w))


@fault("logging", "trajectory")
class ClockDrifts(Spoiled):
    """The clock runs slow by a part in 1e9."""

    def logged(self, trajectory: Trajectory) -> Trajectory:
        """Later and later."""
        return Trajectory(trajectory.time * (1.0 + DRIFT), trajectory.state)


@fault("logging", "scheme")
class OmegaJitters(Spoiled):
    """Noise of a part in 1e9 lies on omega."""

    def logged(self, trajectory: Trajectory) -> Trajectory:
        """Noise that does not come again."""
        state, noise = trajectory.state, getattr(self, "_noise", np.random.default_rng(0))
        self._noise = noise
        factor = 1.0 + JITTER * noise.standard_normal(state.angular_velocity.shape)
        factor[0] = 1.0
        reported = replace(state, angular_velocity=state.angular_velocity * factor)
        return Trajectory(trajectory.time, reported)


@fault("logging", "scheme")
class OneSampleTwice(Spoiled):
    """One sample in the middle of a run is reported twice, and the next is not."""

    def logged(self, trajectory: Trajectory) -> Trajectory:
        """The middle once more."""
        which = np.arange(len(trajectory.time))
        which[len(which) // 2] -= 1
        state = State(*(values[which] for values in vars(trajectory.state).values()))
        return Trajectory(trajectory.time, state)


@fault("logging", "scheme")
class NineDigits(Spoiled):
    """What is reported of a run went through text of nine digits."""

    def logged(self, trajectory: Trajectory) -> Trajectory:
        """Printed and read."""
        fields = {k: digits(v, DIGITS) for k, v in vars(trajectory.state).items()}
        return Trajectory(trajectory.time, State(**fields))


def digits(values: Array, count: int) -> Array:
    """Numbers as text of so many significant digits reports them."""
    reported = [float(f"{value:.{count}g}") for value in np.ravel(values)]
    return np.reshape(np.array(reported), np.shape(values))


@fault("logging", "trajectory")
class StartInSinglePrecision(Spoiled):
    """Runs begin at the state rounded to single precision, and are sound from there."""

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """From the rounded state."""
        fields = {k: v.astype(np.float32).astype(float) for k, v in vars(initial).items()}
        fields["orientation"] = normalize(fields["orientation"])
        return super().run(State(**fields), integrator, timestep, steps, every)


@fault("logging", "trajectory", "asymmetric")
class OmegaDotOfTheSampleBefore(Spoiled):
    """The omega-dot reported along a run is that of the sample before; it is right when queried."""

    running = False

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """What is queried next is of this run."""
        self.running = True
        return super().run(initial, integrator, timestep, steps, every)

    def set_state(self, state: State) -> None:
        """No run any more."""
        self.running = False
        super().set_state(state)

    def forward_dynamics(self, states: State) -> Acceleration:
        """One row late after a run."""
        found, late = super().forward_dynamics(states), self.running
        self.running = False
        angular = found.angular
        if late:
            angular = np.concatenate([angular[:1], angular[:-1]])
        return Acceleration(angular, found.linear)


@fault("stepping", "trajectory", "free")
class NormInSinglePrecision(StepEnds):
    """The quaternion is made unit with a norm of single precision."""

    def end(self, before: State, after: State, dt: float | Array) -> State:
        """As long as the straight step's quaternion over its rounded norm."""
        length = norm(step_ends.straight_quaternion(before, after, dt).orientation)[..., None]
        rounded = np.asarray(length.astype(np.float32), dtype=float)
        return replace(after, orientation=normalize(after.orientation) * (length / rounded))

    def acceleration(self) -> AccelerationOf:
        """Evaluated at the unit quaternion of the same direction, as engines do."""
        sound = self.sound_acceleration()
        return lambda state: sound(replace(state, orientation=normalize(state.orientation)))


@fault("stepping", "scheme", "fast")
class OmegaClampedByComponent(StepEnds):
    """Each component of omega is held within 0.5 rad/s."""

    def end(self, before: State, after: State, dt: float | Array) -> State:
        """No component beyond it."""
        return step_ends.clipped_at(MOST)(before, after, dt)


@fault("stepping", "scheme", "free")
class VelocityIsDamped(StepEnds):
    """The linear velocity loses a part in 1e6 in every step."""

    def end(self, before: State, after: State, dt: float | Array) -> State:
        """A little slower."""
        return replace(after, linear_velocity=(1.0 - 1e-6) * after.linear_velocity)


@fault("stepping", "scheme")
class AttitudeInSinglePrecision(StepEnds):
    """The attitude alone is kept in single precision."""

    def end(self, before: State, after: State, dt: float | Array) -> State:
        """Rounded."""
        return replace(after, orientation=after.orientation.astype(np.float32).astype(float))


@fault("stepping", "scheme", "free gravity")
class PositionByFirstVelocity(StepEnds):
    """The position goes with the velocity at the beginning of a step."""

    def end(self, before: State, after: State, dt: float | Array) -> State:
        """One velocity for the whole step."""
        return replace(after, position=before.position + dt * before.linear_velocity)
