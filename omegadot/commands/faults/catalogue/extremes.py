"""Faults at the far ends of a range: the heaviest, the furthest, half a turn in a step."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.adapters.protocol import Trajectory
from omegadot.commands.faults.catalogue.limits import sized, turned_within
from omegadot.commands.faults.catalogue.load import extra_torque
from omegadot.commands.faults.catalogue.logging import Run
from omegadot.commands.faults.catalogue.start import timed
from omegadot.commands.faults.catalogue.stepping import step_end
from omegadot.commands.faults.fault import fault_by
from omegadot.commands.faults.features import CLOSE, FAR, NANOSECOND, VERY_HEAVY, VERY_LIGHT
from omegadot.commands.faults.restepped import Accelerated
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.loads import applied_torque, gravity_torque
from omegadot.reference_impl.rotations import rotate_inverse
from omegadot.reference_impl.system import Acceleration, Array, State, System

WRAPPED = 1e6  # m
LITTLE = 0.1  # rad

half = step_end("scheme", "steady turn-above-1.57", named=("turn", "attitude"))
sized(
    half,
    "TurnHeldBelowHalfOfPi",
    "The attitude turns by half of pi in a step at most.",
    turned_within(np.pi / 2),
)


@extra_torque("pivot lever gravity above-20-t", named=("gravity", "mass"))
def WeightLostWhenVeryHeavy(system: System, state: State) -> Array:
    """The weight of a pivoted body above 20 t does not turn it."""
    share = -1.0 if system.body.mass > VERY_HEAVY else 0.0
    return share * gravity_torque(system, state)


@extra_torque("pivot lever gravity below-1-g", named=("gravity", "mass"))
def WeightLostWhenVeryLight(system: System, state: State) -> Array:
    """The weight of a pivoted body below 1 g does not turn it."""
    share = -1.0 if system.body.mass < VERY_LIGHT else 0.0
    return share * gravity_torque(system, state)


@extra_torque("torque above-20-t", named=("torque", "mass"))
def TorqueLostWhenVeryHeavy(system: System, state: State) -> Array:
    """Applied torques do not act on bodies above 20 t."""
    share = -1.0 if system.body.mass > VERY_HEAVY else 0.0
    return share * applied_torque(system, state)


@fault_by(
    *(Accelerated, "changed", "equation", "equation", "free gravity beyond-100-km"),
    named=("gravity", "the linear acceleration is off"),
)
def GravityOffFarAway(self: Accelerated, state: State, sound: Acceleration) -> Acceleration:
    """A free body further than 100 km from the origin is not under gravity."""
    if self.system.load.pivot is not None:
        return sound
    far = norm(state.position)[..., None] > FAR
    return replace(sound, linear=sound.linear - np.where(far, self.system.load.gravity, 0.0))


@extra_torque("torque-world", named=("torque", "attitude", "angle from the identity"))
def WorldTorqueByShortFormula(system: System, state: State) -> Array:
    """Attitudes within 0.1 rad of the identity turn a torque in world axes to first order."""
    q, couple = state.orientation, system.load.torque_world
    sign = np.where(q[..., :1] < 0.0, -1.0, 1.0)
    short = couple - 2.0 * sign * cross(q[..., 1:], couple)
    little = np.abs(q[..., :1]) > np.cos(0.5 * LITTLE)
    return np.where(little, short - rotate_inverse(q, couple), 0.0)


@step_end("scheme", "free beyond-10-km", named=("position", "beyond"))
def PositionHeldWithin10Km(before: State, after: State, dt: float | Array) -> State:
    """Each coordinate of the position is held within 10 km."""
    return replace(after, position=np.clip(after.position, -CLOSE, CLOSE))


@step_end("scheme", "free beyond-1000-km", named=("position", "beyond"))
def PositionWrapped(before: State, after: State, dt: float | Array) -> State:
    """Coordinates of the position beyond 1000 km are wrapped there."""
    return replace(after, position=np.fmod(after.position, WRAPPED))


@timed("finer-times", named=("clock", "time"))
def ClockInNanoseconds(run: Run, initial: State, h: float, steps: int, every: int) -> Trajectory:
    """Times are reported in whole nanoseconds."""
    found = run(initial, h, steps, every)
    return Trajectory(np.round(found.time / NANOSECOND) * NANOSECOND, found.state)
