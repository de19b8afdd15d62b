"""Stepping an engine's dynamics anew, with a fault in the acceleration, the scheme or the step."""

from __future__ import annotations

import numpy as np

from omegadot.adapters.protocol import Integrator, Trajectory
from omegadot.adapters.reference import ReferenceAdapter
from omegadot.harness.faults.fault import Spoiled
from omegadot.reference_impl.body_origin import from_origin, is_offset, to_origin
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.motion import acceleration_of
from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.schemes import SCHEMES, AccelerationOf, Scheme
from omegadot.reference_impl.stepping import step_through
from omegadot.reference_impl.system import Acceleration, Array, State, System


def on_rows(forward: AccelerationOf) -> AccelerationOf:
    """An engine's forward dynamics, which takes n rows, for states of any leading axes."""

    def acceleration(state: State) -> Acceleration:
        fields = vars(state)
        lead = np.broadcast_shapes(*(f.shape[:-1] for f in fields.values()))
        rows = {
            name: np.broadcast_to(f, (*lead, f.shape[-1])).reshape(-1, f.shape[-1])
            for name, f in fields.items()
        }
        found = forward(State(**rows))
        return Acceleration(found.angular.reshape(*lead, 3), found.linear.reshape(*lead, 3))

    return acceleration


def at_origin(system: System, of_center: AccelerationOf) -> AccelerationOf:
    """The same accelerations of states told at the body's origin."""
    c = system.body.center_of_mass

    def acceleration(state: State) -> Acceleration:
        found, w = of_center(from_origin(system, state)), state.angular_velocity
        lever = cross(found.angular, c) + cross(w, cross(w, c))
        return Acceleration(found.angular, found.linear - rotate(state.orientation, lever))

    return acceleration


def step_anew(
    system: System,
    acceleration: AccelerationOf,
    scheme: Scheme,
    origin: bool,
    initial: State,
    plan: tuple[float, int, int],
) -> tuple[Array, State]:
    """Times and states of a scheme over any acceleration. plan: the step in s, steps, every."""
    told_at_origin = origin and is_offset(system)
    start = to_origin(system, initial) if told_at_origin else initial
    rate = at_origin(system, acceleration) if told_at_origin else acceleration
    times, states = step_through(scheme, system, rate, start, *plan)
    return times, from_origin(system, states) if told_at_origin else states


class Restepped(Spoiled):
    """The engine's own forward dynamics, stepped by the scheme that its integrator declares.

    An integrator that declares none is stepped by semi-implicit Euler.
    """

    def sound_acceleration(self) -> AccelerationOf:
        """The engine's forward dynamics; the reference's without forming its constants anew."""
        if isinstance(self.inner, ReferenceAdapter):
            return acceleration_of(self.inner.system)
        return on_rows(self.inner.forward_dynamics)

    def acceleration(self) -> AccelerationOf:
        """What is stepped."""
        return self.sound_acceleration()

    def scheme(self, declared: Scheme) -> Scheme:
        """The scheme that is stepped."""
        return declared

    def integrator(self, name: str) -> Integrator:
        """The integrator as the sound engine declares it for the loaded system."""
        return next(i for i in self.inner.description.integrators if i.name == name)

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """As `Adapter.run`, by the reference's stepping."""
        declared = self.integrator(integrator)
        scheme = self.scheme(SCHEMES[declared.scheme or "semi-implicit-euler"])
        how = (self.loaded(self.system), self.acceleration(), scheme, declared.steps_origin)
        plan = (timestep, steps, every)
        return self.logged(Trajectory(*step_anew(*how, self.into(initial), plan)))


class Accelerated(Restepped):
    """A fault in the dynamics: both what is told of the acceleration and what is stepped."""

    def changed(self, state: State, sound: Acceleration) -> Acceleration:
        """The wrong acceleration in place of a sound one."""
        return sound

    def acceleration(self) -> AccelerationOf:
        """The wrong acceleration."""
        sound = self.sound_acceleration()
        return lambda state: self.changed(state, sound(state))

    def forward_dynamics(self, states: State) -> Acceleration:
        """As `Adapter.forward_dynamics`, with the fault."""
        return self.changed(states, super().forward_dynamics(states))
