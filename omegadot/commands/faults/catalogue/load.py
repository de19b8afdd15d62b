"""Faults of the loads: gravity, torques, damping and the pivot act otherwise than requested."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.commands.faults.fault import Spoiled, fault
from omegadot.commands.faults.restepped import Accelerated
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import weight
from omegadot.reference_impl.motion import center_of_mass_acceleration
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array, Load, State, System


class OtherLoad(Spoiled):
    """The engine is given the load that `other` makes of the one requested."""

    def other(self, load: Load) -> Load:
        """The wrong load."""
        return load

    def loaded(self, system: System) -> System:
        """The system with the wrong load."""
        return replace(system, load=self.other(system.load))


@fault("equation", "equation", "gravity")
class GravityReversed(OtherLoad):
    """Gravity has the wrong sign."""

    def other(self, load: Load) -> Load:
        """Upwards."""
        return replace(load, gravity=-load.gravity)


@fault("equation", "equation", "gravity")
class GravityIgnored(OtherLoad):
    """Gravity does not act."""

    def other(self, load: Load) -> Load:
        """None."""
        return replace(load, gravity=np.zeros_like(load.gravity))


@fault("equation", "equation", "gravity")
class GravitySlightlyOff(OtherLoad):
    """Gravity is 0.1 % too strong."""

    def other(self, load: Load) -> Load:
        """A thousandth more."""
        return replace(load, gravity=1.001 * load.gravity)


class ExtraTorque(Accelerated):
    """A torque about the centre of mass, or the pivot, that was not requested."""

    def torque(self, state: State) -> Array:
        """(..., 3) N m, body axes."""
        return np.zeros_like(state.angular_velocity)

    def changed(self, state: State, sound: Acceleration) -> Acceleration:
        """The torque's omega-dot added; a pivoted body's centre of mass goes along."""
        more = apply(inverse(moving_inertia(self.system)), self.torque(state))
        angular = sound.angular + more
        if self.system.load.pivot is None:
            return Acceleration(angular, sound.linear)
        return Acceleration(angular, center_of_mass_acceleration(self.system, state, angular))


@fault("equation", "equation", "gravity offset")
class GravityAtOrigin(ExtraTorque):
    """Gravity acts at the body's origin instead of the centre of mass."""

    def torque(self, state: State) -> Array:
        """The weight with the lever from the centre of mass back to the origin."""
        force = rotate_inverse(state.orientation, weight(self.system))
        return cross(-self.system.body.center_of_mass, force)


@fault("equation", "equation", "gravity")
class GravityInBodyAxes(Accelerated):
    """Gravity is fixed to the body instead of the world."""

    def changed(self, state: State, sound: Acceleration) -> Acceleration:
        """The weight turned along with the body."""
        system, g = self.system, self.system.load.gravity
        if system.load.pivot is None:
            return Acceleration(sound.angular, sound.linear - g + rotate(state.orientation, g))
        r = system.body.center_of_mass - system.load.pivot
        wrong = cross(r, system.body.mass * (g - rotate_inverse(state.orientation, g)))
        angular = sound.angular + apply(inverse(moving_inertia(system)), wrong)
        return Acceleration(angular, center_of_mass_acceleration(system, state, angular))


@fault("equation", "equation", "torque")
class TorqueInWrongFrame(OtherLoad):
    """The applied torque is taken in the wrong frame: body for world, world for body."""

    def other(self, load: Load) -> Load:
        """The two exchanged."""
        return replace(load, torque_body=load.torque_world, torque_world=load.torque_body)


@fault("equation", "equation", "torque")
class TorqueIgnored(OtherLoad):
    """The applied torque does not act."""

    def other(self, load: Load) -> Load:
        """None."""
        none = np.zeros_like(load.torque_body)
        return replace(load, torque_body=none, torque_world=none)


@fault("equation", "equation", "damping")
class DampingIgnored(OtherLoad):
    """The damping does not act."""

    def other(self, load: Load) -> Load:
        """None."""
        return replace(load, damping=np.zeros_like(load.damping))


@fault("equation", "equation", "damping")
class DampingReversed(OtherLoad):
    """The damping drives instead of braking."""

    def other(self, load: Load) -> Load:
        """The wrong sign."""
        return replace(load, damping=-load.damping)


@fault("equation", "equation", "pivot-off-origin")
class PivotAtOrigin(OtherLoad):
    """The body is pivoted at its origin instead of the pivot."""

    def other(self, load: Load) -> Load:
        """The pivot at the origin."""
        return replace(load, pivot=None if load.pivot is None else np.zeros_like(load.pivot))


@fault("equation", "equation", "pivot-off-origin")
class PivotMirrored(OtherLoad):
    """The pivot lies on the other side of the body's origin."""

    def other(self, load: Load) -> Load:
        """The wrong sign."""
        return replace(load, pivot=None if load.pivot is None else -load.pivot)


@fault("equation", "equation", "pivot")
class PivotIgnored(OtherLoad):
    """The pivot holds nothing: the body is free."""

    def other(self, load: Load) -> Load:
        """No pivot."""
        return replace(load, pivot=None)
