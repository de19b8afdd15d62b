"""Faults of the loads: gravity, torques, damping and the pivot act otherwise than requested."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from omegadot.commands.faults.fault import OtherSystem, fault_by
from omegadot.commands.faults.restepped import Accelerated
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import weight
from omegadot.reference_impl.motion import center_of_mass_acceleration
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array, Load, State, System


class OtherLoad(OtherSystem):
    """The engine is given the load that `other` makes of the one requested."""

    other: Callable[[Load], Load]

    def loaded(self, system: System) -> System:
        """The system with the wrong load."""
        return replace(system, load=self.other(system.load))


other_load = partial(fault_by, OtherLoad, "other", "equation", "equation")


@other_load("gravity", named="gravity has the wrong sign")
def GravityReversed(load: Load) -> Load:
    """Gravity has the wrong sign."""
    return replace(load, gravity=-load.gravity)


@other_load("gravity", named="gravity is missing")
def GravityIgnored(load: Load) -> Load:
    """Gravity does not act."""
    return replace(load, gravity=np.zeros_like(load.gravity))


@other_load("gravity", named="gravity is scaled by 1.001")
def GravitySlightlyOff(load: Load) -> Load:
    """Gravity is 0.1 % too strong."""
    return replace(load, gravity=1.001 * load.gravity)


def pushed(system: System, state: State, sound: Acceleration, torque: Array) -> Acceleration:
    """With one more torque in body axes; a pivoted body's centre of mass goes along."""
    angular = sound.angular + apply(inverse(moving_inertia(system)), torque)
    if system.load.pivot is None:
        return Acceleration(angular, sound.linear)
    return Acceleration(angular, center_of_mass_acceleration(system, state, angular))


class ExtraTorque(Accelerated):
    """A torque about the centre of mass, or the pivot, that was not requested.

    torque: (..., 3) N m, body axes.
    """

    torque: Callable[[System, State], Array]

    def changed(self, state: State, sound: Acceleration) -> Acceleration:
        """The torque's omega-dot added."""
        return pushed(self.system, state, sound, self.torque(self.system, state))


extra_torque = partial(fault_by, ExtraTorque, "torque", "equation", "equation")


@extra_torque("gravity offset", named="gravity acts at the body's origin")
def GravityAtOrigin(system: System, state: State) -> Array:
    """Gravity acts at the body's origin instead of the centre of mass."""
    force = rotate_inverse(state.orientation, weight(system))
    return cross(-system.body.center_of_mass, force)


@fault_by(
    Accelerated, "changed", "equation", "equation", "gravity", named="gravity is fixed to the body"
)
def GravityInBodyAxes(self: Accelerated, state: State, sound: Acceleration) -> Acceleration:
    """Gravity is fixed to the body instead of the world."""
    system, g = self.system, self.system.load.gravity
    if system.load.pivot is None:
        return Acceleration(sound.angular, sound.linear - g + rotate(state.orientation, g))
    r = system.body.center_of_mass - system.load.pivot
    wrong = cross(r, system.body.mass * (g - rotate_inverse(state.orientation, g)))
    return pushed(system, state, sound, wrong)


@other_load("torque", named="the applied torque is taken in the wrong frame")
def TorqueInWrongFrame(load: Load) -> Load:
    """The applied torque is taken in the wrong frame: body for world, world for body."""
    return replace(load, torque_body=load.torque_world, torque_world=load.torque_body)


@other_load("torque", named="the applied torque is missing")
def TorqueIgnored(load: Load) -> Load:
    """The applied torque does not act."""
    none = np.zeros_like(load.torque_body)
    return replace(load, torque_body=none, torque_world=none)


@other_load("damping", named="the damping is missing")
def DampingIgnored(load: Load) -> Load:
    """The damping does not act."""
    return replace(load, damping=np.zeros_like(load.damping))


@other_load("damping", named="the damping has the wrong sign")
def DampingReversed(load: Load) -> Load:
    """The damping drives instead of braking."""
    return replace(load, damping=-load.damping)


@other_load("pivot-off-origin", named="is pivoted at its origin")
def PivotAtOrigin(load: Load) -> Load:
    """The body is pivoted at its origin instead of the pivot."""
    return replace(load, pivot=None if load.pivot is None else np.zeros_like(load.pivot))


@other_load("pivot-off-origin", named="the pivot has the wrong sign")
def PivotMirrored(load: Load) -> Load:
    """The pivot lies on the other side of the body's origin."""
    return replace(load, pivot=None if load.pivot is None else -load.pivot)


@other_load("pivot", named="the pivot is ignored")
def PivotIgnored(load: Load) -> Load:
    """The pivot holds nothing: the body is free."""
    return replace(load, pivot=None)
