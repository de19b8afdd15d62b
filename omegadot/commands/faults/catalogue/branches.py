"""Faults of branches: one load is forgotten where another acts, or in an untested case."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from omegadot.commands.faults.catalogue.load import extra_torque, other_load, pushed
from omegadot.commands.faults.fault import fault_by
from omegadot.commands.faults.restepped import Accelerated
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia, parallel_axis
from omegadot.reference_impl.loads import applied_torque, damping_torque
from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array, Load, State, System

accelerated = partial(fault_by, Accelerated, "changed", "equation", "equation")


def driven(load: Load) -> bool:
    """Whether a torque is applied."""
    return bool(np.any(load.torque_body) or np.any(load.torque_world))


def when(holds: bool, load: Load, **changes: Array) -> Load:
    """The load with these changes, where something holds."""
    return replace(load, **changes) if holds else load


NONE, NO_DAMPING = np.zeros(3), np.zeros(())


@other_load("damping torque", named="torque")
def TorqueLostWhenDamped(load: Load) -> Load:
    """Applied torques do not act where there is damping: an elif for an if."""
    return when(bool(np.any(load.damping)), load, torque_body=NONE, torque_world=NONE)


@other_load("damping torque", named="damping")
def DampingLostWhenDriven(load: Load) -> Load:
    """Damping does not act where a torque is applied: an elif for an if."""
    return when(driven(load), load, damping=NO_DAMPING)


@other_load("gravity torque", named="gravity")
def GravityLostWhenDriven(load: Load) -> Load:
    """Gravity does not act where a torque is applied: an elif for an if."""
    return when(driven(load), load, gravity=NONE)


@other_load("gravity damping", named="gravity")
def GravityLostWhenDamped(load: Load) -> Load:
    """Gravity does not act where there is damping: an elif for an if."""
    return when(bool(np.any(load.damping)), load, gravity=NONE)


@other_load("pivot lever gravity", named="gravity")
def GravityCompensatedOnPivots(load: Load) -> Load:
    """A pivoted body's weight is compensated; a free one falls."""
    return when(load.pivot is not None, load, gravity=NONE)


@other_load("free gravity", named="gravity")
def GravityCompensatedWhenFree(load: Load) -> Load:
    """A free body's weight is compensated; a pivoted one's acts."""
    return when(load.pivot is None, load, gravity=NONE)


@other_load("pivot damping", named="damping")
def DampingLostOnPivots(load: Load) -> Load:
    """Damping does not act on a pivoted body."""
    return when(load.pivot is not None, load, damping=NO_DAMPING)


@other_load("pivot torque", named="torque")
def TorqueFrameOnPivots(load: Load) -> Load:
    """A pivoted body's torque is taken in the wrong frame: body for world, world for body."""
    swapped = {"torque_body": load.torque_world, "torque_world": load.torque_body}
    return when(load.pivot is not None, load, **swapped)


@other_load("gravity-not-down", named="gravity")
def GravityAlongMinusZ(load: Load) -> Load:
    """Gravity has its size and acts along -z, whatever its direction."""
    return replace(load, gravity=np.array([0.0, 0.0, -1.0]) * norm(load.gravity))


@other_load("gravity-oblique", named="gravity")
def GravityXYSwapped(load: Load) -> Load:
    """Gravity's x and y are swapped; they are both zero in most scenarios."""
    return replace(load, gravity=load.gravity[..., [1, 0, 2]])


def one_axis_reversed(torque: Array) -> Array:
    """With its y reversed."""
    return np.asarray(torque * np.array([1.0, -1.0, 1.0]))


@other_load("torque", named="torque")
def TorqueReversedOnOneAxis(load: Load) -> Load:
    """The y component of an applied torque has the wrong sign."""
    body, world = one_axis_reversed(load.torque_body), one_axis_reversed(load.torque_world)
    return replace(load, torque_body=body, torque_world=world)


def driven_twice(load: Load) -> bool:
    """Whether a torque in body axes acts and one in world axes."""
    return bool(np.any(load.torque_body) and np.any(load.torque_world))


@other_load(
    "torque-body torque-world", named="the torque in body axes is taken for one in world axes"
)
def TorquesSummedInWorldAxes(load: Load) -> Load:
    """Where torques in body and in world axes both act, their sum is taken in world axes."""
    both = load.torque_body + load.torque_world
    return when(driven_twice(load), load, torque_body=NONE, torque_world=both)


@other_load("torque-body torque-world", named="the torque in world axes is missing")
def WorldTorqueLostWhenDrivenInBodyAxes(load: Load) -> Load:
    """A torque in world axes does not act where one in body axes does: an elif for an if."""
    return when(driven_twice(load), load, torque_world=NONE)


@accelerated("damping", named="rate")
def DampingAsRate(self: Accelerated, state: State, sound: Acceleration) -> Acceleration:
    """Damping is a rate, not a torque: omega-dot has ``-d omega`` whatever the inertia."""
    system, w = self.system, state.angular_velocity
    tensor = moving_inertia(system)
    as_torque = -system.load.damping * apply(tensor, w) - damping_torque(system, state)
    return pushed(system, state, sound, as_torque)


@extra_torque("damping", named=("torque is multiplied by the mass", "the damping that acts is"))
def DampingTimesMass(system: System, state: State) -> Array:
    """The damping torque is multiplied by the mass."""
    return (system.body.mass - 1.0) * damping_torque(system, state)


@accelerated("free damping", named=("linear damping", "linear"))
def DampingOfTranslation(self: Accelerated, state: State, sound: Acceleration) -> Acceleration:
    """Damping acts on the linear velocity, too, as a force ``-d v`` in N."""
    if self.system.load.pivot is not None:
        return sound
    braking = self.system.load.damping / self.system.body.mass * state.linear_velocity
    return Acceleration(sound.angular, sound.linear - braking)


@accelerated("free torque offset", named=("origin", "torque"))
def CoupleAtOrigin(self: Accelerated, state: State, sound: Acceleration) -> Acceleration:
    """A couple acts as if at the body's origin, which stays, and so moves the centre of mass."""
    body = self.system.body
    if self.system.load.pivot is not None:
        return sound
    about_origin = body.inertia + parallel_axis(body.mass, body.center_of_mass)
    couple = applied_torque(self.system, state)
    turned = apply(inverse(about_origin), couple)
    moved = rotate(state.orientation, cross(turned, body.center_of_mass))
    angular = sound.angular + turned - apply(inverse(body.inertia), couple)
    return Acceleration(angular, sound.linear + moved)
