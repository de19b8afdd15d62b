"""Faults of coarse steps: right as the step vanishes, and wrong at the steps that people take."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from omegadot.commands.faults.catalogue.equation import gyroscopic_term
from omegadot.commands.faults.catalogue.load import pushed
from omegadot.commands.faults.catalogue.stepping import StepEnds, step_end
from omegadot.commands.faults.fault import fault, fault_by
from omegadot.commands.faults.features import LONG_STEP
from omegadot.commands.faults.restepped import Restepped
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import damping_torque
from omegadot.reference_impl.motion import AccelerationOf
from omegadot.reference_impl.one_body.body_motion import motion_over
from omegadot.reference_impl.rotations import normalize, quaternion_product, rotation_between
from omegadot.reference_impl.schemes import SCHEMES, Motion, Scheme
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array, State

LARGE_TURN = 0.05  # rad, of one step
LARGE_FOR_EULER = 0.1  # rad, of one step

otherwise = partial(fault_by, Restepped, "scheme", "stepping", "scheme")


@step_end("scheme", "turn-above-0.05", named=("attitude", "exponential", "turn"))
def ExponentialOfSecondOrder(before: State, after: State, dt: float | Array) -> State:
    """The exponential of a turn above 0.05 rad is taken to second order, and made unit."""
    turn = rotation_between(before.orientation, after.orientation)
    angle = norm(turn)[..., None]
    short = normalize(np.concatenate([1.0 - 0.125 * angle**2, 0.5 * turn], axis=-1))
    turned = quaternion_product(before.orientation, short)
    return replace(after, orientation=np.where(angle > LARGE_TURN, turned, after.orientation))


@otherwise("asymmetric step-above-15-ms", named=("gyroscopic", "step"))
def GyroscopicOffAtCoarseSteps(self: Restepped, declared: Scheme) -> Scheme:
    """The gyroscopic term is missing in steps of more than 15 ms."""
    system, sound = self.loaded(self.system), self.acceleration()

    def without(state: State) -> Acceleration:
        return pushed(system, state, sound(state), gyroscopic_term(system, state))

    wrong = motion_over(system, self.coordinates, without)

    def step(motion: Motion, q: Array, v: Array, h: Any) -> tuple[Array, Array]:
        return declared.step(wrong if h > LONG_STEP else motion, q, v, h)

    return replace(declared, step=step)


@fault_by(
    Restepped,
    "scheme",
    "stepping",
    "scheme trajectory",
    "order-4 turn-above-0.10",
    named=("semi-implicit-euler", "step"),
)
def EulerAtCoarseSteps(self: Restepped, declared: Scheme) -> Scheme:
    """Steps that turn by more than 0.1 rad are Euler's, whatever is declared."""
    euler = SCHEMES["semi-implicit-euler"]

    def step(motion: Motion, q: Array, v: Array, h: Any) -> tuple[Array, Array]:
        large = float(norm(v[..., -3:])) * h > LARGE_FOR_EULER
        return (euler if large else declared).step(motion, q, v, h)

    return replace(declared, step=step)


@otherwise("order-4 attitude-dependent", named=("torque", "attitude", "held"))
def LoadsHeldInStep(self: Restepped, declared: Scheme) -> Scheme:
    """The loads' directions are those at the beginning of a step in all of its stages."""

    def step(motion: Motion, q: Array, v: Array, h: Any) -> tuple[Array, Array]:
        held = replace(motion, acceleration=lambda _, later: motion.acceleration(q, later))
        return declared.step(held, q, v, h)

    return replace(declared, step=step)


@fault("stepping", "scheme", "order-4 damping", named=("damping", "semi-implicit-euler"))
class DampingSplitOff(StepEnds):
    """Damping is left out of the stages, and acts once at the end of each step as Euler does."""

    def _damped(self, state: State) -> Array:
        """The damping's omega-dot."""
        system = self.system
        return apply(inverse(moving_inertia(system)), damping_torque(system, state))

    def acceleration(self) -> AccelerationOf:
        """Without damping."""
        sound = self.sound_acceleration()

        def undamped(state: State) -> Acceleration:
            torque = -damping_torque(self.system, state)
            return pushed(self.system, state, sound(state), torque)

        return undamped

    def end(self, before: State, after: State, dt: float | Array) -> State:
        """With one of Euler's steps by the damping alone."""
        w = after.angular_velocity + dt * self._damped(after)
        return replace(after, angular_velocity=w)
