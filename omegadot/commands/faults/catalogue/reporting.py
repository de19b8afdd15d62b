"""Faults in what is reported of a run that is sound: half a step off, smoothed, rounded, noisy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.adapters.protocol import Trajectory
from omegadot.commands.faults.catalogue.logging import Run, half_a_step_back, other_run, rows
from omegadot.commands.faults.catalogue.stepping import long_step_end, step_end
from omegadot.commands.faults.fault import Spoiled, fault, logged
from omegadot.diagnosis.stepping import step_ends
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.rotations import normalize, turn_in_body
from omegadot.reference_impl.system import Acceleration, Array, State, System

JITTER = 1e-9  # of omega
DRIFT = 1e-9  # of the clock
MOST = 0.5  # rad/s, of a component


@other_run("logging", "scheme", named="the attitude reported is that of half a step before")
def AttitudeAtHalfStep(run: Run, initial: State, h: float, steps: int, every: int) -> Trajectory:
    """The attitude reported is that of half a step before."""
    found = run(initial, h, steps, every)
    back = turn_in_body(found.state.orientation[1:], found.state.angular_velocity[1:], -0.5 * h)
    reported = np.concatenate([found.state.orientation[:1], back])
    return Trajectory(found.time, replace(found.state, orientation=reported))


@fault("logging", "scheme", "asymmetric", named="omega is reported as of half a step before")
class OmegaAtHalfStep(Spoiled):
    """omega is that of half a step before."""

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """Taken back by half a step's omega-dot, but for the start."""
        found = super().run(initial, integrator, timestep, steps, every)
        w_dot = self.inner.forward_dynamics(found.state).angular
        w = half_a_step_back(found.state.angular_velocity, w_dot, timestep)
        return Trajectory(found.time, replace(found.state, angular_velocity=w))


@logged("logging", "trajectory", named="every time is too large, by 1e-9 of it")
def ClockDrifts(self: Spoiled, trajectory: Trajectory) -> Trajectory:
    """The clock runs slow by a part in 1e9."""
    return Trajectory(trajectory.time * (1.0 + DRIFT), trajectory.state)


@fault("logging", "scheme", named="omega alone is wrong in the run")
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


@logged("logging", "scheme", named="the one before, reported twice")
def OneSampleTwice(self: Spoiled, trajectory: Trajectory) -> Trajectory:
    """One sample in the middle of a run is reported twice, and the next is not."""
    which = np.arange(len(trajectory.time))
    which[len(which) // 2] -= 1
    return Trajectory(trajectory.time, rows(trajectory.state, which))


@logged("logging", "scheme", named="have 9 digits")
def NineDigits(self: Spoiled, trajectory: Trajectory) -> Trajectory:
    """What is reported of a run went through text of nine digits."""
    rounded = np.vectorize(lambda value: float(f"{value:.9g}"))
    return Trajectory(trajectory.time, State(*map(rounded, vars(trajectory.state).values())))


@other_run("logging", "trajectory", named="is sound from where it begins")
def StartInSinglePrecision(
    run: Run, initial: State, h: float, steps: int, every: int
) -> Trajectory:
    """Runs begin at the state rounded to single precision, and are sound from there."""
    fields = {k: v.astype(np.float32).astype(float) for k, v in vars(initial).items()}
    fields["orientation"] = normalize(fields["orientation"])
    return run(State(**fields), h, steps, every)


@fault(
    "logging",
    "trajectory",
    "asymmetric",
    named="the omega-dot reported along the run is that of the sample before",
)
class OmegaDotOfTheSampleBefore(Spoiled):
    """The omega-dot reported along a run is that of the sample before; it is right when queried."""

    running = False

    def load(self, system: System) -> None:
        """No run of this system yet."""
        self.running = False
        super().load(system)

    def logged(self, trajectory: Trajectory) -> Trajectory:
        """What is queried next is of this run."""
        self.running = True
        return trajectory

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


@long_step_end("trajectory", "free", named="not of unit length")
def NormInSinglePrecision(before: State, after: State, dt: float | Array) -> State:
    """The quaternion is made unit with a norm of single precision."""
    length = norm(step_ends.straight_quaternion(before, after, dt).orientation)[..., None]
    rounded = np.asarray(length.astype(np.float32), dtype=float)
    return replace(after, orientation=normalize(after.orientation) * (length / rounded))


@step_end("scheme", "fast", named="each component of omega is held within 0.5")
def OmegaClampedByComponent(before: State, after: State, dt: float | Array) -> State:
    """Each component of omega is held within 0.5 rad/s."""
    return step_ends.clipped_at(MOST)(before, after, dt)


@step_end("scheme", "free", named="the linear velocity")
def VelocityIsDamped(before: State, after: State, dt: float | Array) -> State:
    """The linear velocity loses a part in 1e6 in every step."""
    return replace(after, linear_velocity=(1.0 - 1e-6) * after.linear_velocity)


@step_end("scheme", named="attitude is kept in single precision")
def AttitudeInSinglePrecision(before: State, after: State, dt: float | Array) -> State:
    """The attitude alone is kept in single precision."""
    return replace(after, orientation=after.orientation.astype(np.float32).astype(float))


@step_end("scheme", "free gravity", named="the position moves by the velocity of the")
def PositionByFirstVelocity(before: State, after: State, dt: float | Array) -> State:
    """The position goes with the velocity at the beginning of a step."""
    return replace(after, position=before.position + dt * before.linear_velocity)
