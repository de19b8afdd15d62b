"""Faults of the equation of motion itself: the gyroscopic term, and the omega-dot reported."""

from __future__ import annotations

from functools import partial

import numpy as np

from omegadot.commands.faults.catalogue.load import extra_torque
from omegadot.commands.faults.fault import Spoiled, fault_by
from omegadot.diagnosis.restep import on_rows, step_again
from omegadot.gates.scales import norm
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import applied_torque, damping_torque, torque
from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array, State, System

forward_dynamics = partial(fault_by, Spoiled, "forward_dynamics", "equation", "equation")
inverse_dynamics = partial(fault_by, Spoiled, "inverse_dynamics", "equation", "equation")


def gyroscopic_term(system: System, state: State) -> Array:
    """``omega x I omega``."""
    w = state.angular_velocity
    return cross(w, apply(moving_inertia(system), w))


@extra_torque("asymmetric", named="the gyroscopic term is missing")
def GyroscopicDropped(system: System, state: State) -> Array:
    """The gyroscopic term is missing."""
    return gyroscopic_term(system, state)


@extra_torque("asymmetric", named="the gyroscopic term has the wrong sign")
def GyroscopicReversed(system: System, state: State) -> Array:
    """The gyroscopic term has the wrong sign, as equation (9) is printed."""
    return 2.0 * gyroscopic_term(system, state)


@extra_torque("asymmetric", named="the gyroscopic term counts twice")
def GyroscopicDoubled(system: System, state: State) -> Array:
    """The gyroscopic term counts twice."""
    return -gyroscopic_term(system, state)


@extra_torque("asymmetric", named="the gyroscopic term is scaled by 1.01")
def GyroscopicOnePercentOff(system: System, state: State) -> Array:
    """The gyroscopic term is 1 % too large."""
    return (1.0 - 1.01) * gyroscopic_term(system, state)


@extra_torque("asymmetric", named="the gyroscopic term is scaled by 1.0001")
def GyroscopicSlightlyOff(system: System, state: State) -> Array:
    """The gyroscopic term is 0.01 % too large."""
    return (1.0 - 1.0001) * gyroscopic_term(system, state)


@forward_dynamics("asymmetric", named="omega-dot looks like world axes")
def OmegaDotInWorld(self: Spoiled, states: State) -> Acceleration:
    """omega-dot is right and reported in world axes."""
    found = self.inner.forward_dynamics(states)
    return Acceleration(rotate(states.orientation, found.angular), found.linear)


@forward_dynamics("asymmetric", named="omega-dot is the same at every state")
def OmegaDotConstant(self: Spoiled, states: State) -> Acceleration:
    """omega-dot is that of the first state requested, whatever comes after."""
    found = self.inner.forward_dynamics(states)
    return Acceleration(np.broadcast_to(found.angular[:1], found.angular.shape), found.linear)


@forward_dynamics("asymmetric", named="a difference quotient")
def OmegaDotByDifference(self: Spoiled, states: State) -> Acceleration:
    """omega-dot is a difference quotient over a short step, passed off as exact."""
    found = self.inner.forward_dynamics(states)
    h = float(1e-4 / np.max(norm(states.angular_velocity)))
    how = (self.system, on_rows(self.inner.forward_dynamics), SCHEMES["lie-rk4"])
    moved = step_again(*how, "com-world", states, (h, 1, 1))[1].angular_velocity[-1]
    return Acceleration((moved - states.angular_velocity) / h, found.linear)


@forward_dynamics("offset", named="acceleration looks like that of the body's origin")
def AccelerationOfOrigin(self: Spoiled, states: State) -> Acceleration:
    """The linear acceleration reported is that of the body's origin."""
    found, w = self.inner.forward_dynamics(states), states.angular_velocity
    c = self.system.body.center_of_mass
    lever = cross(found.angular, c) + cross(w, cross(w, c))
    return Acceleration(found.angular, found.linear - rotate(states.orientation, lever))


@inverse_dynamics("asymmetric", named="inverse dynamics leave out the gyroscopic term")
def InverseWithoutGyroscopic(self: Spoiled, states: State, acceleration: Acceleration) -> Array:
    """Inverse dynamics leaves out the gyroscopic term; all else is sound."""
    found = self.inner.inverse_dynamics(states, acceleration)
    return found - gyroscopic_term(self.system, states)


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
