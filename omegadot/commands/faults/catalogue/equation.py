"""Faults of the equation of motion itself: the gyroscopic term, and the omega-dot reported."""

from __future__ import annotations

from functools import partial

import numpy as np

from omegadot.commands.faults.catalogue.load import extra_torque
from omegadot.commands.faults.fault import Spoiled, fault_by
from omegadot.diagnosis.stepping.restep import on_rows, step_again
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
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


@forward_dynamics(
    "asymmetric",
    named=("omega-dot is the same at every state", "each has the omega-dot of the first"),
)
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
