"""Faults of convention: frames, orders and reference points that two codes do not share.

A fault *throughout* acts on what goes in and on what comes out, so that a state survives the round
trip unchanged and only the motion shows it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.adapters.protocol import Trajectory
from omegadot.commands.faults.fault import Spoiled, fault
from omegadot.reference_impl.kinematics import at_point
from omegadot.reference_impl.rotations import conjugate, rotate, rotate_inverse
from omegadot.reference_impl.system import State


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
    """States are misread on the way in, and on the way out in just the same way."""

    def taken(self, state: State) -> State:
        """The inverse of `reported`."""
        return state

    def into(self, state: State) -> State:
        """Misread."""
        return self.taken(state)


def omega_in_world(state: State) -> State:
    """Omega turned from body to world axes."""
    return replace(state, angular_velocity=rotate(state.orientation, state.angular_velocity))


def omega_in_body(state: State) -> State:
    """Omega turned from world to body axes."""
    w = rotate_inverse(state.orientation, state.angular_velocity)
    return replace(state, angular_velocity=w)


def transposed(state: State) -> State:
    """The inverse rotation."""
    return replace(state, orientation=conjugate(state.orientation))


def scalar_last(state: State) -> State:
    """The quaternion as (x, y, z, w)."""
    return replace(state, orientation=np.roll(state.orientation, -1, axis=-1))


def scalar_first(state: State) -> State:
    """The inverse of `scalar_last`."""
    return replace(state, orientation=np.roll(state.orientation, 1, axis=-1))


@fault("convention", "model")
class OmegaInWorldReadBack(Spoiled):
    """omega is read back in world axes."""

    def read_back(self, state: State) -> State:
        """In the world."""
        return omega_in_world(state)


@fault("convention", "scheme")
class OmegaInWorldInRuns(Spoiled):
    """omega is logged in world axes during a run."""

    def logged(self, trajectory: Trajectory) -> Trajectory:
        """In the world."""
        return Trajectory(trajectory.time, omega_in_world(trajectory.state))


@fault("convention", "equation")
class OmegaInWorldThroughout(Throughout):
    """omega is read and reported in world axes, so that what goes in comes out."""

    def taken(self, state: State) -> State:
        """As if it were given in the world."""
        return omega_in_body(state)

    def reported(self, state: State) -> State:
        """In the world."""
        return omega_in_world(state)


@fault("convention", "model")
class RotationTransposed(Misread):
    """The rotation is reported transposed."""

    def reported(self, state: State) -> State:
        """Transposed."""
        return transposed(state)


@fault("convention", "scheme")
class RotationTransposedThroughout(Throughout):
    """The rotation is read and reported transposed, so that what goes in comes out."""

    def taken(self, state: State) -> State:
        """Transposed."""
        return transposed(state)

    def reported(self, state: State) -> State:
        """Transposed."""
        return transposed(state)


@fault("convention", "model")
class QuaternionScalarLast(Misread):
    """The quaternion is reported as x, y, z, w."""

    def reported(self, state: State) -> State:
        """Scalar last."""
        return scalar_last(state)


@fault("convention", "scheme")
class QuaternionScalarLastThroughout(Throughout):
    """The quaternion is read as x, y, z, w and reported so, so that what goes in comes out."""

    def taken(self, state: State) -> State:
        """As if the scalar came last."""
        return scalar_first(state)

    def reported(self, state: State) -> State:
        """Scalar last."""
        return scalar_last(state)


@fault("convention", "model")
class QuaternionNotUnit(Misread):
    """The quaternion reported is a millionth too long."""

    def reported(self, state: State) -> State:
        """The right direction, another length."""
        return replace(state, orientation=(1.0 + 1e-6) * state.orientation)


@fault("convention", "model", "offset")
class PositionOfOrigin(Misread):
    """The position reported is that of the body's origin, not of the centre of mass."""

    def reported(self, state: State) -> State:
        """At the origin."""
        return replace(state, position=at_point(state, -self.system.body.center_of_mass).position)


@fault("convention", "model", "offset")
class VelocityOfOrigin(Misread):
    """The velocity reported is that of the body's origin, not of the centre of mass."""

    def reported(self, state: State) -> State:
        """At the origin."""
        velocity = at_point(state, -self.system.body.center_of_mass).linear_velocity
        return replace(state, linear_velocity=velocity)


@fault("convention", "model", "free")
class VelocityInBodyAxes(Misread):
    """The velocity is reported in body axes."""

    def reported(self, state: State) -> State:
        """In the body."""
        velocity = rotate_inverse(state.orientation, state.linear_velocity)
        return replace(state, linear_velocity=velocity)


@fault("convention", "model")
class OmegaInDegrees(Misread):
    """omega is reported in degrees per second."""

    def reported(self, state: State) -> State:
        """In degrees."""
        return replace(state, angular_velocity=np.rad2deg(state.angular_velocity))
