"""Engines that step another scheme than they say, or one that no one knows."""

from __future__ import annotations

import numpy as np

from omegadot.adapters.protocol import Description, Integrator, Trajectory, UnsupportedError
from omegadot.adapters.reference.adapter import FEATURES, ReferenceAdapter
from omegadot.reference_impl.motion import acceleration_of
from omegadot.reference_impl.rotations import turn_in_body
from omegadot.reference_impl.schemes import SCHEMES, AccelerationOf, Scheme
from omegadot.reference_impl.schemes.scheme import every_channel, per_component
from omegadot.reference_impl.stepping import step_through
from omegadot.reference_impl.system import Array, State, System


class Misdeclared(ReferenceAdapter):
    """The reference with one integrator that declares `declared` and steps `stepped`."""

    declared: str | None = "lie-rk4"
    stepped: Scheme = SCHEMES["lie-rk4"]

    @property
    def description(self) -> Description:
        integrator = Integrator("step", self.declared, every_channel(4))
        return Description(type(self).__name__.lower(), "1.0", (integrator,), features=FEATURES)

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        how = (self.stepped, self.system, acceleration_of(self.system))
        return Trajectory(*step_through(*how, initial, timestep, steps, every))


class EulerAsRungeKutta(Misdeclared):
    stepped = SCHEMES["semi-implicit-euler"]


class NaiveAsRungeKutta(Misdeclared):
    """Right in omega, and of order 2 instead of 4 in attitude."""

    stepped = SCHEMES["lie-rk4-naive"]


def _explicit_midpoint(acceleration: AccelerationOf, state: State, dt: float | Array) -> State:
    h = per_component(dt)
    found = acceleration(state)
    half = State(
        turn_in_body(state.orientation, state.angular_velocity, 0.5 * h),
        state.angular_velocity + 0.5 * h * found.angular,
        state.position + 0.5 * h * state.linear_velocity,
        state.linear_velocity + 0.5 * h * found.linear,
    )
    middle = acceleration(half)
    return State(
        turn_in_body(state.orientation, half.angular_velocity, h),
        state.angular_velocity + h * middle.angular,
        state.position + h * half.linear_velocity,
        state.linear_velocity + h * middle.linear,
    )


class Unheard(Misdeclared):
    """An explicit midpoint rule of order 2, which the reference does not have; free bodies only."""

    declared = None
    stepped = Scheme("explicit-midpoint", "", _explicit_midpoint, every_channel(2))

    def load(self, system: System) -> None:
        if system.load.pivot is not None:
            raise UnsupportedError("there are no joints here.")
        super().load(system)


class AlmostEuler(Misdeclared):
    """Semi-implicit Euler that turns by 1e-9 too much: no scheme that is known."""

    declared = "semi-implicit-euler"

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        def step(acceleration: AccelerationOf, state: State, dt: float | Array) -> State:
            end = SCHEMES["semi-implicit-euler"].step(acceleration, state, dt)
            more = 1e-9 * np.asarray(end.angular_velocity)
            turned = turn_in_body(end.orientation, more, per_component(dt))
            return State(turned, end.angular_velocity, end.position, end.linear_velocity)

        scheme = Scheme("almost", "", step, every_channel(1))
        how = (scheme, self.system, acceleration_of(self.system))
        return Trajectory(*step_through(*how, initial, timestep, steps, every))
