"""Faults that are small, or that show at times only: at some steps or speeds, in one answer."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from omegadot.commands.faults.catalogue.equation import gyroscopic_term, inverse_dynamics
from omegadot.commands.faults.catalogue.load import extra_torque, other_load, pushed
from omegadot.commands.faults.fault import Spoiled, fault, fault_by
from omegadot.commands.faults.restepped import Restepped
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.loads import applied_torque, gravity_torque, torque
from omegadot.reference_impl.one_body.body_motion import motion_over
from omegadot.reference_impl.schemes import SCHEMES, Motion, Scheme
from omegadot.reference_impl.system import Acceleration, Array, Load, State, System

FIRST_STEPS = ("only the first steps are wrong", "at the start of a run alone")
ASIDE = np.array([1e-6, 0.0, 0.0])  # m


class Timed(Restepped):
    """Steps that know their number: each is taken with `wrong` or with the right acceleration.

    wrong_scheme: of a wrong step, where it is not the declared one.
    """

    wrong_scheme: Scheme | None = None

    def wrong_at(self, step: int) -> bool:
        """Whether this step is a wrong one; they are counted from 0."""
        return step == 0

    def wrong(self, state: State, sound: Acceleration) -> Acceleration:
        """The acceleration of a wrong step."""
        return sound

    def scheme(self, declared: Scheme) -> Scheme:
        """The declared scheme, with a counter."""
        taken, sound = iter(range(self.steps + 1)), self.acceleration()
        system = self.loaded(self.system)
        wrong = motion_over(system, self.coordinates, lambda x: self.wrong(x, sound(x)))

        def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
            if not self.wrong_at(next(taken)):
                return declared.step(motion, q, v, h)
            return (self.wrong_scheme or declared).step(wrong, q, v, h)

        return replace(declared, step=step)


first_step = partial(fault_by, Timed, "wrong", "stepping", "scheme", named=FIRST_STEPS)


@first_step("gravity")
def GravityOffInFirstStep(self: Timed, state: State, sound: Acceleration) -> Acceleration:
    """Gravity does not act yet in the first step."""
    if self.system.load.pivot is None:
        return Acceleration(sound.angular, sound.linear - self.system.load.gravity)
    return pushed(self.system, state, sound, -gravity_torque(self.system, state))


@first_step("torque")
def TorqueOneStepLate(self: Timed, state: State, sound: Acceleration) -> Acceleration:
    """The applied torque acts one step late, and so not at all in the first."""
    return pushed(self.system, state, sound, -applied_torque(self.system, state))


@fault("stepping", "scheme", "asymmetric order-4", named=FIRST_STEPS)
class FirstStepByEuler(Timed):
    """The first step is one of Euler's, whatever is declared."""

    wrong_scheme = SCHEMES["semi-implicit-euler"]


@fault("stepping", "scheme", named="is sound until")
class DampingAfterAWhile(Timed):
    """From the middle of a run on, a damping acts that was not requested."""

    def wrong_at(self, step: int) -> bool:
        """The second half."""
        return step >= self.steps // 2

    def wrong(self, state: State, sound: Acceleration) -> Acceleration:
        """A thousandth of omega, lost at the rate of the motion."""
        w = state.angular_velocity
        return Acceleration(sound.angular - 1e-3 * norm(w)[..., None] * w, sound.linear)


@extra_torque("asymmetric", named="only where omega_z is below")
def GyroscopicOffAtNegativeSpin(system: System, state: State) -> Array:
    """The gyroscopic term is 1 % too large where the spin about z is negative."""
    backwards = state.angular_velocity[..., 2:] < 0.0
    return np.where(backwards, -0.01 * gyroscopic_term(system, state), 0.0)


@extra_torque("asymmetric fast", named="only where |omega| is above")
def GyroscopicOffWhenFast(system: System, state: State) -> Array:
    """The gyroscopic term is 1 % too large above 1 rad/s."""
    fast = norm(state.angular_velocity)[..., None] > 1.0
    return np.where(fast, -0.01 * gyroscopic_term(system, state), 0.0)


@extra_torque("torque", named="only where the angle from the identity is above")
def TorqueOffFarFromIdentity(system: System, state: State) -> Array:
    """The applied torque is missing where the body has turned by more than 2 rad."""
    far = np.abs(state.orientation[..., :1]) < np.cos(1.0)
    return np.where(far, -applied_torque(system, state), 0.0)


@other_load("pivot", named=("the pivot lies at", "the pivot lies 1e-6 m"))
def PivotSlightlyOff(load: Load) -> Load:
    """The pivot lies a thousandth of a millimetre aside."""
    return replace(load, pivot=None if load.pivot is None else load.pivot + ASIDE)


@other_load("gravity-oblique", named=("gravity is (", "gravity's components are permuted"))
def GravityAxesPermuted(load: Load) -> Load:
    """Gravity's components stand under the wrong axes: y up for z up."""
    return replace(load, gravity=np.roll(load.gravity, 1))


@extra_torque("torque", named=("it is divided by the mass", "all loads is scaled by"))
def TorqueOverMass(system: System, state: State) -> Array:
    """The torques of the loads are divided by the mass, as forces are."""
    return (1.0 / system.body.mass - 1.0) * torque(system, state)


@inverse_dynamics("pivot gravity", named="inverse dynamics leave out gravity")
def InverseWithoutGravity(self: Spoiled, states: State, acceleration: Acceleration) -> Array:
    """Inverse dynamics leave out gravity; all else is sound."""
    found = self.inner.inverse_dynamics(states, acceleration)
    return np.asarray(found + gravity_torque(self.system, states))
