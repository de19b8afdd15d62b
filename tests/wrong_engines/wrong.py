"""Engines whose answers are wrong: a sound one with one thing broken in each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from omegadot.adapters.protocol import Description, Trajectory
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.diagnosis.stepping.restep import step_again
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.motion import acceleration_of
from omegadot.reference_impl.rotations import conjugate, rotate
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import Acceleration, Array, Body, State, System

ONE_SCHEME = "semi-implicit-euler"


class Wrong(ReferenceAdapter):
    """The reference with one scheme, over an acceleration that a subclass may spoil."""

    @property
    def description(self) -> Description:
        whole = super().description
        kept = tuple(i for i in whole.integrators if i.name == ONE_SCHEME)
        return Description(type(self).__name__.lower(), "1.0", kept, features=whole.features)

    def acceleration_of(self, system: System) -> Callable[[State], Acceleration]:
        return acceleration_of(system)

    def forward_dynamics(self, states: State) -> Acceleration:
        return self.acceleration_of(self.system)(states)

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        how = (self.system, self.acceleration_of(self.system), SCHEMES[ONE_SCHEME], "com-world")
        return Trajectory(*step_again(*how, initial, (timestep, steps, every)))


class Sound(Wrong):
    """Nothing is broken: it must not be accused."""


class Gyroscopic(Wrong):
    """The gyroscopic term times `factor` instead of one."""

    factor = 1.0

    def acceleration_of(self, system: System) -> Callable[[State], Acceleration]:
        right, inertia = acceleration_of(system), moving_inertia(system)
        inverse = np.linalg.inv(inertia)

        def acceleration(state: State) -> Acceleration:
            found, w = right(state), state.angular_velocity
            gyroscopic = cross(w, (inertia @ w[..., None])[..., 0])
            more = (1.0 - self.factor) * (inverse @ gyroscopic[..., None])[..., 0]
            return Acceleration(found.angular + more, found.linear)

        return acceleration


class SignAsPrinted(Gyroscopic):
    """Equation (9) as the paper prints it, without its minus sign."""

    factor = -1.0


class NoGyroscopic(Gyroscopic):
    factor = 0.0


class GyroscopicSlightlyOff(Gyroscopic):
    factor = 1.0001


class OmegaDotInWorld(Wrong):
    """omega-dot is right and reported in the wrong axes."""

    def forward_dynamics(self, states: State) -> Acceleration:
        found = super().forward_dynamics(states)
        return Acceleration(rotate(states.orientation, found.angular), found.linear)


class MassSlightlyOff(Wrong):
    def model(self) -> tuple[Body, ...]:
        return (replace(self.system.body, mass=1.001 * self.system.body.mass),)


class DiagonalInertia(Wrong):
    """Only the diagonal of the tensor is taken over."""

    def load(self, system: System) -> None:
        body = system.body
        diagonal = replace(body, inertia=np.diag(np.diag(body.inertia)))
        super().load(replace(system, bodies=(diagonal,)))


class TransposedAttitude(Wrong):
    def get_state(self) -> State:
        state = super().get_state()
        return replace(state, orientation=conjugate(state.orientation))


class GravityUpwards(Wrong):
    def load(self, system: System) -> None:
        super().load(replace(system, load=replace(system.load, gravity=-system.load.gravity)))


class SecretDamping(Wrong):
    """1e-4 N m s/rad that was not requested, in the stepping only."""

    def acceleration_of(self, system: System) -> Callable[[State], Acceleration]:
        return acceleration_of(replace(system, load=replace(system.load, damping=np.array(1e-4))))

    def forward_dynamics(self, states: State) -> Acceleration:
        return acceleration_of(self.system)(states)


class StepSlightlyLong(Wrong):
    """Steps are 0.1 % longer than it states."""

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        found = super().run(initial, integrator, 1.001 * timestep, steps, every)
        return Trajectory(found.time / 1.001, found.state)


class FirstSampleMissing(Wrong):
    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        found = super().run(initial, integrator, timestep, steps, every)
        rest = State(*(values[1:] for values in vars(found.state).values()))
        return Trajectory(found.time[1:], rest)


class LogsOneSampleLate(Wrong):
    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        found = super().run(initial, integrator, timestep, steps, every)

        def late(values: Array) -> Array:
            return np.concatenate([values[:1], values[:-1]])

        return Trajectory(found.time, State(*(late(v) for v in vars(found.state).values())))


class EnergyCorrected(Wrong):
    """Omega is rescaled so that the energy looks right."""

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        found = super().run(initial, integrator, timestep, steps, every)
        w, inertia = found.state.angular_velocity, self.system.body.inertia
        energy = np.einsum("ni,ij,nj->n", w, inertia, w)
        scaled = w * np.sqrt(energy[0] / energy)[:, None]
        return Trajectory(found.time, replace(found.state, angular_velocity=scaled))


class FallsAsleep(Wrong):
    """Below 0.05 rad/s the body is put to rest."""

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        found = super().run(initial, integrator, timestep, steps, every)
        w = found.state.angular_velocity.copy()
        w[np.linalg.norm(w, axis=-1) < 0.05] = 0.0
        return Trajectory(found.time, replace(found.state, angular_velocity=w))


class DampedForgetsTorque(Wrong):
    """Where the body is damped, applied torques are forgotten."""

    def acceleration_of(self, system: System) -> Callable[[State], Acceleration]:
        if system.load.damping:
            none = {"torque_body": np.zeros(3), "torque_world": np.zeros(3)}
            system = replace(system, load=replace(system.load, **none))
        return acceleration_of(system)


class OneStateAlone(NoGyroscopic):
    """Wrong where a single state is requested, and right for many at once."""

    def forward_dynamics(self, states: State) -> Acceleration:
        alone = len(states.angular_velocity) == 1
        return super().forward_dynamics(states) if alone else acceleration_of(self.system)(states)

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        how = (self.system, acceleration_of(self.system), SCHEMES[ONE_SCHEME], "com-world")
        return Trajectory(*step_again(*how, initial, (timestep, steps, every)))


class FirstRunAfterLoad(Wrong):
    """The first run after a load begins with twice the omega."""

    fresh = False

    def load(self, system: System) -> None:
        super().load(system)
        self.fresh = True

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        factor, self.fresh = 2.0 if self.fresh else 1.0, False
        start = replace(initial, angular_velocity=factor * initial.angular_velocity)
        return super().run(start, integrator, timestep, steps, every)


class EveryRunAddsDamping(Wrong):
    """Each run leaves some damping for the next ones."""

    runs = 0

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        self.runs += 1
        return super().run(initial, integrator, timestep, steps, every)

    def acceleration_of(self, system: System) -> Callable[[State], Acceleration]:
        size = float(np.trace(system.body.inertia)) * 1e-7 * self.runs
        return acceleration_of(
            replace(system, load=replace(system.load, damping=system.load.damping + size))
        )


class ScalarMadePositive(Wrong):
    """A start with a negative scalar part is taken for another attitude: its vector is kept."""

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        scalar = np.abs(initial.orientation[:1])
        start = replace(initial, orientation=np.append(scalar, initial.orientation[1:]))
        return super().run(start, integrator, timestep, steps, every)


class KeepsGravity(Wrong):
    """Gravity that was loaded once is never taken off again."""

    gravity = np.zeros(3)

    def load(self, system: System) -> None:
        if np.any(system.load.gravity):
            self.gravity = system.load.gravity
        super().load(replace(system, load=replace(system.load, gravity=self.gravity)))


class LastIntervalWhole(Wrong):
    """The last interval between samples is taken to be as long as the others."""

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        found = super().run(initial, integrator, timestep, steps, every)
        whole = -(-steps // every) * every
        last = super().run(initial, integrator, timestep, whole, every).state[-1:]

        def ended(values: Array, end: Array) -> Array:
            return np.concatenate([values[:-1], end])

        pairs = zip(vars(found.state).values(), vars(last).values(), strict=True)
        return Trajectory(found.time, State(*(ended(*pair) for pair in pairs)))


class DampingClamped(Wrong):
    """A damping of more than 1 N m s/rad is taken for 1."""

    def acceleration_of(self, system: System) -> Callable[[State], Acceleration]:
        least = np.minimum(system.load.damping, 1.0)
        return acceleration_of(replace(system, load=replace(system.load, damping=least)))


class GravityAlwaysDown(Wrong):
    """Gravity has the size requested, and points along -z."""

    def acceleration_of(self, system: System) -> Callable[[State], Acceleration]:
        down = np.array([0.0, 0.0, -np.linalg.norm(system.load.gravity)])
        return acceleration_of(replace(system, load=replace(system.load, gravity=down)))


class FastSpinsDamped(Wrong):
    """What spins faster than 5 rad/s is damped, slower spins are sound."""

    def acceleration_of(self, system: System) -> Callable[[State], Acceleration]:
        right = acceleration_of(system)

        def acceleration(state: State) -> Acceleration:
            found, w = right(state), state.angular_velocity
            fast = np.linalg.norm(w, axis=-1, keepdims=True) > 5.0
            return Acceleration(found.angular - np.where(fast, 0.1 * w, 0.0), found.linear)

        return acceleration


class FastStepsDamped(FastSpinsDamped):
    """The same in its steps alone."""

    def forward_dynamics(self, states: State) -> Acceleration:
        return acceleration_of(self.system)(states)


class RefusesLongSteps(ReferenceAdapter):
    """Sound, but for steps that it does not take."""

    def run(self, *arguments: object) -> Trajectory:
        if arguments[3] in (13, 15):  # the coarsest runs of random systems
            raise ArithmeticError("no solution")
        return super().run(*arguments)
