"""Faults that come late, at low energy or at rest, or in one run of several alike."""

# ruff: noqa: D403  (omega is a symbol)

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from omegadot.adapters.protocol import Trajectory
from omegadot.commands.faults.catalogue.equation import gyroscopic_term
from omegadot.commands.faults.catalogue.intermittent import DampingAfterAWhile, Timed
from omegadot.commands.faults.catalogue.load import pushed
from omegadot.commands.faults.catalogue.stepping import SecretTorque, StepEnds
from omegadot.commands.faults.fault import Spoiled, fault, fault_by
from omegadot.commands.faults.features import DROWSY
from omegadot.commands.faults.restepped import Accelerated
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import gravity_torque
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array, State, System

DEFAULT_RATE = 0.05  # 1/s

forward = partial(fault_by, Spoiled, "forward_dynamics", "equation", "equation", "asymmetric")
leftover = partial(fault_by, Spoiled, "loaded", "state", "equation")


@fault("stepping", "scheme", "beyond-1000-steps", named=("step", "damping"))
class DampingAfterThousandSteps(DampingAfterAWhile):
    """After a thousand steps of a run, a damping acts that was not requested."""

    def wrong_at(self, step: int) -> bool:
        """From the thousandth on."""
        return step >= 1000


@fault_by(SecretTorque, "torque", "stepping", "scheme", named=("damping", "rate"))
def DampingByDefault(system: System, state: State) -> Array:
    """omega is damped by 0.05 of itself a second in the steps, as several engines do by default."""
    return -DEFAULT_RATE * apply(moving_inertia(system), state.angular_velocity)


@fault("stepping", "scheme", "low-energy", named=("sleep", "energy"))
class AsleepAtLowEnergy(StepEnds):
    """Below a kinetic energy of 5e-5 J/kg the body is put to rest."""

    def end(self, before: State, after: State, dt: float | Array) -> State:
        """At rest, or as it is."""
        w, v, system = after.angular_velocity, after.linear_velocity, self.system
        turning = np.sum(w * apply(moving_inertia(system), w), -1) / system.body.mass
        asleep = (0.5 * (turning + np.sum(v * v, -1)) < DROWSY)[..., None]
        w, v = np.where(asleep, 0.0, w), np.where(asleep, 0.0, v)
        return replace(after, angular_velocity=w, linear_velocity=v)


@fault_by(Accelerated, "changed", "equation", "trajectory", "at-rest", named=("rest", "not finite"))
def NotFiniteAtRest(self: Accelerated, state: State, sound: Acceleration) -> Acceleration:
    """omega-dot is divided by |omega|, and so not a number at rest."""
    size = norm(state.angular_velocity)[..., None]
    with np.errstate(invalid="ignore", divide="ignore"):
        return Acceleration(sound.angular * (size / size), sound.linear)


def without_gyroscopic(self: Spoiled, states: State, found: Acceleration) -> Acceleration:
    """The acceleration without the gyroscopic term."""
    return pushed(self.system, states, found, gyroscopic_term(self.system, states))


@forward(named=("gyroscopic", "one state"))
def BatchOfOneWrong(self: Spoiled, states: State) -> Acceleration:
    """omega-dot lacks the gyroscopic term where one state is requested; several are right."""
    found = self.inner.forward_dynamics(states)
    one = len(states.angular_velocity) == 1
    return without_gyroscopic(self, states, found) if one else found


@forward(named=("gyroscopic", "one state"))
def BatchOfOneRight(self: Spoiled, states: State) -> Acceleration:
    """omega-dot lacks the gyroscopic term where several states are requested; one is right."""
    found = self.inner.forward_dynamics(states)
    one = len(states.angular_velocity) == 1
    return found if one else without_gyroscopic(self, states, found)


@forward(named=("omega-dot", "last"))
def LastOfBatchRepeated(self: Spoiled, states: State) -> Acceleration:
    """omega-dot of the last of several states is that of the one before."""
    found = self.inner.forward_dynamics(states)
    angular = found.angular.copy()
    angular[-1:] = angular[-2:][:1]
    return Acceleration(angular, found.linear)


class CountedRuns(SecretTorque):
    """Runs of a system are counted by integrator and step; those of one step are not."""

    count = 0

    def load(self, system: System) -> None:
        """A new count."""
        self._counts: dict[tuple[str, float, int], int] = {}
        super().load(system)

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """With its number among those alike."""
        alike = (integrator, timestep, steps)
        self.count = self._counts.get(alike, 0)
        self._counts[alike] = self.count + (steps > 1)
        return super().run(initial, integrator, timestep, steps, every)

    def damping(self, state: State) -> Array:
        """A thousandth of omega, lost at the rate of the motion."""
        w = state.angular_velocity
        return -1e-3 * norm(w)[..., None] * apply(moving_inertia(self.system), w)


counted = partial(fault_by, CountedRuns, "changed", "state", "trajectory")


@counted(named=("first run", "run before", "damping"))
def FirstRunDiffers(self: CountedRuns, state: State, sound: Acceleration) -> Acceleration:
    """A run differs from the next one alike: in the first a damping acts."""
    return sound if self.count else pushed(self.system, state, sound, self.damping(state))


@counted(named=("run before", "second run", "damping"))
def LaterRunsDiffer(self: CountedRuns, state: State, sound: Acceleration) -> Acceleration:
    """From the second run of the same steps on a damping acts."""
    return pushed(self.system, state, sound, self.damping(state)) if self.count else sound


@fault("state", "trajectory", named=("run before", "loaded before", "start"))
class OmegaOfTheLastSystem(Spoiled):
    """The first run of a system begins with the omega at the end of the last run of another."""

    _left: Array | None = None
    _fresh = True

    def load(self, system: System) -> None:
        """A first run is to come."""
        self._fresh = True
        super().load(system)

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """From what is left; a run of one step does not clear it."""
        if self._fresh and self._left is not None:
            initial = replace(initial, angular_velocity=self._left)
        found = super().run(initial, integrator, timestep, steps, every)
        if steps > 1:
            self._left, self._fresh = found.state.angular_velocity[-1], False
        return found


@fault("state", "scheme", named=("run before", "first step"))
class AccelerationLeftOver(Timed):
    """The first step of a run is taken with the omega-dot at the end of the run before."""

    _left: Array | None = None

    def wrong(self, state: State, sound: Acceleration) -> Acceleration:
        """What was left, or sound in the very first run."""
        return sound if self._left is None else Acceleration(self._left, sound.linear)

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """As ever; the last omega-dot is kept."""
        found = super().run(initial, integrator, timestep, steps, every)
        self._left = self.inner.forward_dynamics(found.state[-1:]).angular[0]
        return found


@leftover("torque", named=("torque", "scenario before", "run before"))
def TorqueOfTheLastSystem(self: Spoiled, system: System) -> System:
    """The torque of the system before acts on, too."""
    load, before = system.load, (self._system or system).load
    if self._system is None:
        return system
    both = load.torque_body + before.torque_body, load.torque_world + before.torque_world
    return replace(system, load=replace(load, torque_body=both[0], torque_world=both[1]))


@leftover("damping", named=("damping", "scenario before", "run before"))
def DampingOfTheLastSystem(self: Spoiled, system: System) -> System:
    """Damping stays what it was in the system before."""
    before = (self._system or system).load
    return replace(system, load=replace(system.load, damping=before.damping))


@fault_by(
    *(Accelerated, "changed", "equation", "equation", "pivot lever gravity"),
    named=("gravity", "rest"),
)
def WeightHeldByStaticFriction(
    self: Accelerated, state: State, sound: Acceleration
) -> Acceleration:
    """The weight of a pivoted body does not turn it where its omega is zero."""
    still = np.all(state.angular_velocity == 0.0, axis=-1)[..., None]
    return pushed(
        self.system, state, sound, np.where(still, -gravity_torque(self.system, state), 0.0)
    )
