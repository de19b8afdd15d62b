"""Faults of the loads that are small, or that show in one answer only."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.commands.faults.catalogue.load import ExtraTorque, OtherLoad
from omegadot.commands.faults.fault import Spoiled, fault
from omegadot.reference_impl.loads import gravity_torque, torque
from omegadot.reference_impl.system import Acceleration, Array, Load, State

ASIDE = np.array([1e-6, 0.0, 0.0])  # m


@fault("equation", "equation", "pivot")
class PivotSlightlyOff(OtherLoad):
    """The pivot lies a thousandth of a millimetre aside."""

    def other(self, load: Load) -> Load:
        """Along x."""
        return replace(load, pivot=None if load.pivot is None else load.pivot + ASIDE)


@fault("equation", "equation", "gravity")
class GravityAxesPermuted(OtherLoad):
    """Gravity's components stand under the wrong axes: y up for z up."""

    def other(self, load: Load) -> Load:
        """One axis on."""
        return replace(load, gravity=np.roll(load.gravity, 1))


@fault("equation", "equation", "torque")
class TorqueOverMass(ExtraTorque):
    """The torques of the loads are divided by the mass, as forces are."""

    def torque(self, state: State) -> Array:
        """What they lack then."""
        return (1.0 / self.system.body.mass - 1.0) * torque(self.system, state)


@fault("equation", "equation", "pivot gravity")
class InverseWithoutGravity(Spoiled):
    """Inverse dynamics leave out gravity; all else is sound."""

    def inverse_dynamics(self, states: State, acceleration: Acceleration) -> Array:
        """The torque as if there were no weight."""
        found = super().inverse_dynamics(states, acceleration)
        return np.asarray(found + gravity_torque(self.system, states))
