"""Faults in the dynamics, the scheme or the step: the engine's own dynamics, stepped again."""

from __future__ import annotations

from omegadot.adapters.protocol import Trajectory
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.commands.faults.fault import Spoiled
from omegadot.diagnosis.stepping.restep import on_rows, step_again
from omegadot.reference_impl.coordinates import Coordinates
from omegadot.reference_impl.motion import AccelerationOf, acceleration_of
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.schemes import SCHEMES, Motion, Scheme
from omegadot.reference_impl.system import Acceleration, State


class Restepped(Spoiled):
    """The engine's own forward dynamics, stepped by the scheme that its integrator declares.

    An integrator that declares none is stepped by semi-implicit Euler.
    steps, coordinates: of the present run.
    """

    steps = 0
    coordinates: Coordinates = "com-world"

    def sound_acceleration(self) -> AccelerationOf:
        """The engine's forward dynamics; the reference's without forming its constants again."""
        if isinstance(self.inner, ReferenceAdapter):
            return acceleration_of(self.inner.system)
        return on_rows(self.inner.forward_dynamics)

    def acceleration(self) -> AccelerationOf:
        """What is stepped."""
        return self.sound_acceleration()

    def scheme(self, declared: Scheme) -> Scheme:
        """The scheme that is stepped."""
        return declared

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """As `Adapter.run`, by the reference's stepping."""
        declared = next(i for i in self.inner.description.integrators if i.name == integrator)
        self.steps, self.coordinates = steps, declared.coordinates
        scheme = self.scheme(SCHEMES[declared.scheme or "semi-implicit-euler"])
        how = (self.loaded(self.system), self.acceleration(), scheme, self.coordinates)
        plan = (timestep, steps, every)
        return self.logged(Trajectory(*step_again(*how, self.into(initial), plan, self._motion())))

    def _motion(self) -> Motion | None:
        """The reference's own motion, which is quicker, where the dynamics are the reference's."""
        own = type(self).acceleration is Restepped.acceleration
        if not own or not isinstance(self.inner, ReferenceAdapter):
            return None
        return body_motion(self.inner.system, self.coordinates)


class Accelerated(Restepped):
    """A fault in the dynamics: both what is reported of the acceleration and what is stepped.

    is_in_dynamics: whether what is reported of the acceleration shows it.
    """

    is_in_dynamics = True

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
