"""Faults of solving: what inverse dynamics leaves out, and what torques are divided by."""

from __future__ import annotations

import numpy as np

from omegadot.commands.faults.catalogue.equation import (
    forward_dynamics,
    gyroscopic_term,
    inverse_dynamics,
)
from omegadot.commands.faults.catalogue.load import extra_torque
from omegadot.commands.faults.catalogue.precision import in_single
from omegadot.commands.faults.fault import Spoiled
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import applied_torque, damping_torque, torque
from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.symmetric import apply, inverse
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


@extra_torque("asymmetric", named="the inverse of the inertia is kept in single precision")
def InverseInertiaInSinglePrecision(system: System, state: State) -> Array:
    """The inverse of the inertia is kept in single precision, and the inertia in double."""
    inertia = moving_inertia(system)
    moment = torque(system, state) - gyroscopic_term(system, state)
    return np.asarray(apply(inertia, apply(in_single(inverse(inertia)), moment)) - moment)


@extra_torque("full-inertia", named="the lower triangle of the inertia is zero")
def InertiaLowerTriangleLost(system: System, state: State) -> Array:
    """The lower triangle of the inertia is taken for zero: only one of each pair is filled in."""
    w, tensor = state.angular_velocity, moving_inertia(system)
    upper = np.triu(tensor)
    wrong = apply(np.linalg.inv(upper), torque(system, state) - cross(w, apply(upper, w)))
    return apply(tensor, wrong) - (torque(system, state) - gyroscopic_term(system, state))


@inverse_dynamics("asymmetric", named="omega-dot x I omega for the gyroscopic term")
def InverseGyroscopicByOmegaDot(self: Spoiled, states: State, acceleration: Acceleration) -> Array:
    """Inverse dynamics has ``omega-dot x I omega`` for the gyroscopic term; all else is sound."""
    found, system = self.inner.inverse_dynamics(states, acceleration), self.system
    momentum = apply(moving_inertia(system), states.angular_velocity)
    wrong = cross(acceleration.angular, momentum)
    return np.asarray(found - gyroscopic_term(system, states) + wrong)


def _by_diagonal(system: System, torque: Array) -> Array:
    """What a torque must change by so that solving with I gives ``torque / diag(I)``."""
    tensor = moving_inertia(system)
    return apply(tensor, torque / np.diag(tensor)) - torque
