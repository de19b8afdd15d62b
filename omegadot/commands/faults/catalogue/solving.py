"""Faults of solving: what inverse dynamics leaves out, and what torques are divided by."""

from __future__ import annotations

import numpy as np

from omegadot.commands.faults.catalogue.equation import (
    forward_dynamics,
    gyroscopic_term,
    inverse_dynamics,
)
from omegadot.commands.faults.catalogue.load import extra_torque
from omegadot.commands.faults.fault import Spoiled
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import applied_torque, damping_torque, torque
from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array, State, System


@inverse_dynamics("damping", named="inverse dynamics")
def InverseWithoutDamping(self: Spoiled, states: State, acceleration: Acceleration) -> Array:
    """Inverse dynamics leaves the damping out of what it gives; all else is sound."""
    found = self.inner.inverse_dynamics(states, acceleration)
    return np.asarray(found - damping_torque(self.system, states))


@inverse_dynamics("damping", named="inverse dynamics")
def InverseDampingDoubled(self: Spoiled, states: State, acceleration: Acceleration) -> Array:
    """Inverse dynamics counts the damping twice; all else is sound."""
    found = self.inner.inverse_dynamics(states, acceleration)
    return np.asarray(found + damping_torque(self.system, states))


@inverse_dynamics("torque", named="inverse dynamics")
def InverseWithoutTorque(self: Spoiled, states: State, acceleration: Acceleration) -> Array:
    """Inverse dynamics leaves the applied torque out of what it gives; all else is sound."""
    found = self.inner.inverse_dynamics(states, acceleration)
    return np.asarray(found - applied_torque(self.system, states))


@forward_dynamics(named=("spatial", "linear acceleration"))
def AccelerationSpatial(self: Spoiled, states: State) -> Acceleration:
    """The linear acceleration reported is the spatial one, ``a - omega x v``."""
    found = self.inner.forward_dynamics(states)
    w = rotate(states.orientation, states.angular_velocity)
    return Acceleration(found.angular, found.linear - cross(w, states.linear_velocity))


@extra_torque("full-inertia", named=("gyroscopic", "diagonal"))
def GyroscopicOfDiagonal(system: System, state: State) -> Array:
    """The gyroscopic term is formed with the diagonal of the inertia alone."""
    w, tensor = state.angular_velocity, moving_inertia(system)
    return gyroscopic_term(system, state) - cross(w, np.diag(tensor) * w)


@extra_torque("full-inertia", named=("diagonal", "inertia"))
def SolvedByDiagonal(system: System, state: State) -> Array:
    """All torques are divided by the diagonal of the inertia alone."""
    return _by_diagonal(system, torque(system, state) - gyroscopic_term(system, state))


@extra_torque("full-inertia torque", named=("diagonal", "torque"))
def TorqueOverDiagonal(system: System, state: State) -> Array:
    """Applied torques are divided by the diagonal of the inertia alone."""
    return _by_diagonal(system, applied_torque(system, state))


def _by_diagonal(system: System, torque: Array) -> Array:
    """What a torque must change by so that solving with I gives ``torque / diag(I)``."""
    tensor = moving_inertia(system)
    return apply(tensor, torque / np.diag(tensor)) - torque
