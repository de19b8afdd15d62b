"""Faults that come and go: at the first step, after a while, at some speeds or attitudes only."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.adapters.protocol import Trajectory
from omegadot.commands.faults.catalogue.load import ExtraTorque
from omegadot.commands.faults.fault import fault
from omegadot.commands.faults.restepped import Restepped
from omegadot.gates.scales import norm
from omegadot.reference_impl.body_motion import motion_over
from omegadot.reference_impl.coordinates import Coordinates
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import applied_torque, gravity_torque
from omegadot.reference_impl.schemes import SCHEMES, Motion, Scheme
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array, State


class Timed(Restepped):
    """Steps that know their number: each is taken with `early` or with the right acceleration."""

    steps = 0
    coordinates: Coordinates = "com-world"

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """As `Adapter.run`, with the number of steps and the coordinates kept."""
        self.steps, self.coordinates = steps, self.integrator(integrator).coordinates
        return super().run(initial, integrator, timestep, steps, every)

    def wrong_at(self, step: int) -> bool:
        """Whether this step is a wrong one; they are counted from 0."""
        return step == 0

    def wrong(self, state: State, sound: Acceleration) -> Acceleration:
        """The acceleration of a wrong step."""
        return sound

    def wrong_scheme(self, declared: Scheme) -> Scheme:
        """The scheme of a wrong step."""
        return declared

    def scheme(self, declared: Scheme) -> Scheme:
        """The declared scheme, with a counter."""
        taken, sound = iter(range(self.steps + 1)), self.acceleration()
        wrong = motion_over(
            self.loaded(self.system),
            self.coordinates,
            lambda state: self.wrong(state, sound(state)),
        )

        def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
            if not self.wrong_at(next(taken)):
                return declared.step(motion, q, v, h)
            return self.wrong_scheme(declared).step(wrong, q, v, h)

        return replace(declared, step=step)

    def pushed(self, sound: Acceleration, moment: Array) -> Acceleration:
        """With one more torque in body axes."""
        more = apply(inverse(moving_inertia(self.system)), moment)
        return Acceleration(sound.angular + more, sound.linear)


@fault("stepping", "scheme", "gravity")
class GravityOffInFirstStep(Timed):
    """Gravity does not act yet in the first step."""

    def wrong(self, state: State, sound: Acceleration) -> Acceleration:
        """Without weight."""
        if self.system.load.pivot is None:
            return Acceleration(sound.angular, sound.linear - self.system.load.gravity)
        return self.pushed(sound, -gravity_torque(self.system, state))


@fault("stepping", "scheme", "torque")
class TorqueOneStepLate(Timed):
    """The applied torque acts one step late, and so not at all in the first."""

    def wrong(self, state: State, sound: Acceleration) -> Acceleration:
        """Without the torque."""
        return self.pushed(sound, -applied_torque(self.system, state))


@fault("stepping", "scheme", "asymmetric order-4")
class FirstStepByEuler(Timed):
    """The first step is one of Euler's, whatever is declared."""

    def wrong_scheme(self, declared: Scheme) -> Scheme:
        """Euler."""
        return SCHEMES["semi-implicit-euler"]


@fault("stepping", "scheme")
class DampingAfterAWhile(Timed):
    """From the middle of a run on, a damping acts that was not requested."""

    def wrong_at(self, step: int) -> bool:
        """The second half."""
        return step >= self.steps // 2

    def wrong(self, state: State, sound: Acceleration) -> Acceleration:
        """A thousandth of omega, lost at the rate of the motion."""
        w = state.angular_velocity
        return Acceleration(sound.angular - 1e-3 * norm(w)[..., None] * w, sound.linear)


@fault("equation", "equation", "asymmetric")
class GyroscopicOffAtNegativeSpin(ExtraTorque):
    """The gyroscopic term is 1 % too large where the spin about z is negative."""

    def torque(self, state: State) -> Array:
        """A hundredth of it."""
        w = state.angular_velocity
        term = -0.01 * cross(w, apply(moving_inertia(self.system), w))
        return np.where(w[..., 2:] < 0.0, term, 0.0)


@fault("equation", "equation", "asymmetric fast")
class GyroscopicOffWhenFast(ExtraTorque):
    """The gyroscopic term is 1 % too large above 1 rad/s."""

    def torque(self, state: State) -> Array:
        """A hundredth of it."""
        w = state.angular_velocity
        term = -0.01 * cross(w, apply(moving_inertia(self.system), w))
        return np.where(norm(w)[..., None] > 1.0, term, 0.0)


@fault("equation", "equation", "torque")
class TorqueOffFarFromIdentity(ExtraTorque):
    """The applied torque is missing where the body has turned by more than 2 rad."""

    def torque(self, state: State) -> Array:
        """Taken away."""
        far = np.abs(state.orientation[..., :1]) < np.cos(1.0)
        return np.where(far, -applied_torque(self.system, state), 0.0)
