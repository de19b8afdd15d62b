"""Faults of convention: frames, orders and reference points that two codes do not share.

A fault *throughout* acts on what goes in and on what comes out, so that a state survives the round
trip unchanged and only the motion shows it.
"""

# ruff: noqa: D403  (omega is a symbol)

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from omegadot.adapters.protocol import Trajectory
from omegadot.commands.faults.fault import Spoiled, fault, fault_by, logged
from omegadot.reference_impl.kinematics import at_point
from omegadot.reference_impl.rotations import conjugate, rotate, rotate_inverse
from omegadot.reference_impl.system import State

Way = Callable[[Spoiled, State], State]


class Misread(Spoiled):
    """Every state that comes out is reported wrong."""

    def reported(self, state: State) -> State:
        """The wrong state."""
        return state

    def read_back(self, state: State) -> State:
        """Wrong."""
        return self.reported(state)

    def logged(self, trajectory: Trajectory) -> Trajectory:
        """Wrong."""
        return Trajectory(trajectory.time, self.reported(trajectory.state))


class Throughout(Misread):
    """States are misread on the way in, and on the way out in just the same way.

    ways: what is made of a state on its way in and on its way out, each the inverse of the other.
    """

    ways: tuple[Way, Way]

    def into(self, state: State) -> State:
        """Misread."""
        return self.ways[0](self, state)

    def reported(self, state: State) -> State:
        """Misread the same way."""
        return self.ways[1](self, state)


misread = partial(fault_by, Misread, "reported", "convention", "model")


@fault_by(Spoiled, "read_back", "convention", "model", named="omega looks like world axes")
def OmegaInWorldReadBack(self: Spoiled, state: State) -> State:
    """omega is read back in world axes."""
    return replace(state, angular_velocity=rotate(state.orientation, state.angular_velocity))


@logged("convention", "scheme", named="in the run, omega looks like world axes")
def OmegaInWorldInRuns(self: Spoiled, trajectory: Trajectory) -> Trajectory:
    """omega is logged in world axes during a run."""
    return Trajectory(trajectory.time, OmegaInWorldReadBack(self, trajectory.state))


def omega_in_body(self: Spoiled, state: State) -> State:
    """Omega turned from world to body axes."""
    w = rotate_inverse(state.orientation, state.angular_velocity)
    return replace(state, angular_velocity=w)


@fault(
    "convention",
    "equation",
    named=("on the way in, omega looks like world axes", "way out, omega looks"),
)
class OmegaInWorldThroughout(Throughout):
    """omega is read and reported in world axes, so that what goes in comes out."""

    ways = omega_in_body, OmegaInWorldReadBack


@misread(named="the rotation looks transposed")
def RotationTransposed(self: Spoiled, state: State) -> State:
    """The rotation is reported transposed."""
    return replace(state, orientation=conjugate(state.orientation))


@fault("convention", "scheme", named="the rotation looks transposed")
class RotationTransposedThroughout(Throughout):
    """The rotation is read and reported transposed, so that what goes in comes out."""

    ways = RotationTransposed, RotationTransposed


@misread(named="the quaternion looks like (x, y, z, w)")
def QuaternionScalarLast(self: Spoiled, state: State) -> State:
    """The quaternion is reported as x, y, z, w."""
    return replace(state, orientation=np.roll(state.orientation, -1, axis=-1))


def scalar_first(self: Spoiled, state: State) -> State:
    """The inverse of `QuaternionScalarLast`."""
    return replace(state, orientation=np.roll(state.orientation, 1, axis=-1))


@fault("convention", "scheme", named="the quaternion looks like (x, y, z, w)")
class QuaternionScalarLastThroughout(Throughout):
    """The quaternion is read as x, y, z, w and reported so, so that what goes in comes out."""

    ways = scalar_first, QuaternionScalarLast


@misread(named="not of unit length")
def QuaternionNotUnit(self: Spoiled, state: State) -> State:
    """The quaternion reported is a millionth too long."""
    return replace(state, orientation=(1.0 + 1e-6) * state.orientation)


@misread("offset", named="the position looks like that of the body's origin")
def PositionOfOrigin(self: Spoiled, state: State) -> State:
    """The position reported is that of the body's origin, not of the centre of mass."""
    return replace(state, position=at_point(state, -self.system.body.center_of_mass).position)


@misread("offset", named="the linear velocity looks like that of the body's origin")
def VelocityOfOrigin(self: Spoiled, state: State) -> State:
    """The velocity reported is that of the body's origin, not of the centre of mass."""
    velocity = at_point(state, -self.system.body.center_of_mass).linear_velocity
    return replace(state, linear_velocity=velocity)


@misread("free", named="the linear velocity looks like body axes")
def VelocityInBodyAxes(self: Spoiled, state: State) -> State:
    """The velocity is reported in body axes."""
    velocity = rotate_inverse(state.orientation, state.linear_velocity)
    return replace(state, linear_velocity=velocity)


def body_velocity(self: Spoiled, state: State) -> State:
    """A velocity given in body axes, in the world's."""
    return replace(state, linear_velocity=rotate(state.orientation, state.linear_velocity))


@fault("convention", "model", "free", named="is taken as one in body axes when it is set")
class VelocitySetInBodyAxes(Throughout):
    """The velocity that is set is taken as one in body axes, and reported in the world's."""

    ways = body_velocity, lambda self, state: state


@misread(named="degrees per second")
def OmegaInDegrees(self: Spoiled, state: State) -> State:
    """omega is reported in degrees per second."""
    return replace(state, angular_velocity=np.rad2deg(state.angular_velocity))
