"""Faults of thresholds: what is small is dropped, what is large is cut, one for all of a batch."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from omegadot.adapters.protocol import Trajectory
from omegadot.commands.faults.catalogue.equation import gyroscopic_term
from omegadot.commands.faults.catalogue.limits import sized, turned_within
from omegadot.commands.faults.catalogue.load import extra_torque, other_load, pushed
from omegadot.commands.faults.catalogue.model import UnseenBody
from omegadot.commands.faults.catalogue.stepping import step_end
from omegadot.commands.faults.fault import OtherSystem, Spoiled, fault_by
from omegadot.commands.faults.features import (
    DROPPED,
    LEAST_TURN,
    MOST_GRAVITY,
    SLIGHT_DAMPING,
    TON,
)
from omegadot.commands.faults.restepped import Accelerated
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.loads import applied_torque, gravity_torque
from omegadot.reference_impl.rotations import rotate_inverse, rotation_between
from omegadot.reference_impl.system import Acceleration, Array, Body, Load, State, System

MOST_RATIO = 20.0  # of the largest moment to the smallest
LEAST_PRODUCT = 0.01  # of the trace
LARGEST_ACCELERATION = 1e3  # rad/s^2

unseen = partial(fault_by, UnseenBody, "body", "model", "equation")
accelerated = partial(fault_by, Accelerated, "changed", "equation", "equation")


@fault_by(
    OtherSystem, "loaded", "equation", "equation", "above-1-t pivot lever", named=("mass", "ton")
)
def MassHeldBelowATon(self: OtherSystem, system: System) -> System:
    """A mass above a ton is taken for a ton."""
    body = replace(system.body, mass=np.minimum(system.body.mass, TON))
    return replace(system, bodies=(body,))


@other_load("gravity-above-20", named="gravity")
def GravityHeldBelow20(load: Load) -> Load:
    """Gravity above 20 m/s^2 is held there."""
    size = np.maximum(norm(load.gravity), MOST_GRAVITY)
    return replace(load, gravity=load.gravity * (MOST_GRAVITY / size))


@other_load("damping-below-1e-3", named="damping")
def SlightDampingDropped(load: Load) -> Load:
    """A damping below 1e-3 N m s/rad does not act."""
    return replace(load, damping=np.where(load.damping < SLIGHT_DAMPING, 0.0, load.damping))


@extra_torque("asymmetric very-fast", named=("gyroscopic", "omega-dot", "rad/s^2"))
def GyroscopicHeldBelow(system: System, state: State) -> Array:
    """The gyroscopic term is held to what gives 1000 rad/s^2."""
    term = gyroscopic_term(system, state)
    most = LARGEST_ACCELERATION * float(np.linalg.eigvalsh(system.body.inertia)[0])
    return term * (1.0 - most / np.maximum(norm(term), most))[..., None]


@extra_torque("torque at-rest", named=("torque", "rest", "|omega|"))
def TorqueHeldByStaticFriction(system: System, state: State) -> Array:
    """Applied torques do not act on a body that turns by less than 0.01 rad/s."""
    still = norm(state.angular_velocity)[..., None] < DROPPED
    return np.where(still, -applied_torque(system, state), 0.0)


@unseen("ill-conditioned", named="inertia")
def MomentsHeldWithinARatio(body: Body) -> Body:
    """Moments below a 20th of the largest are taken for that."""
    moments, axes = np.linalg.eigh(body.inertia)
    held = np.maximum(moments, moments[-1] / MOST_RATIO)
    return replace(body, inertia=axes @ np.diag(held) @ axes.T)


@unseen("slight-products", named="inertia")
def SlightProductsDropped(body: Body) -> Body:
    """Products of inertia below 1 % of the trace are dropped."""
    least = LEAST_PRODUCT * np.trace(body.inertia)
    kept = np.where(np.abs(body.inertia) < least, 0.0, body.inertia)
    return replace(body, inertia=kept)


@accelerated("torque-world", named=("torque", "orientation", "attitude"))
def WorldTorqueByFirstAttitude(
    self: Accelerated, state: State, sound: Acceleration
) -> Acceleration:
    """A batch's torque in world axes is turned into the body by the first attitude of the batch."""
    couple, q = self.system.load.torque_world, state.orientation
    first = q.reshape(-1, 4)[0]
    wrong = rotate_inverse(first, couple) - rotate_inverse(q, couple)
    return pushed(self.system, state, sound, wrong)


@extra_torque("pivot lever gravity", named=("gravity", "attitude"))
def WeightByPositiveScalar(system: System, state: State) -> Array:
    """The weight's moment takes the scalar part of the attitude by its size alone."""
    q = state.orientation.copy()
    q[..., 0] = np.abs(q[..., 0])
    wrong = gravity_torque(system, replace(state, orientation=q))
    return wrong - gravity_torque(system, state)


quarter = step_end("scheme", "steady turn-above-0.79", named=("turn", "attitude"))
sentence = "The attitude turns by a quarter of pi in a step at most."
sized(quarter, "TurnHeldBelowAQuarterOfPi", sentence, turned_within(np.pi / 4))


@step_end("scheme", "slow", named=("omega", "component", "sleep"))
def SlowComponentsDropped(before: State, after: State, dt: float | Array) -> State:
    """Components of omega below 0.01 rad/s are taken for zero."""
    w = after.angular_velocity
    return replace(after, angular_velocity=np.where(np.abs(w) < DROPPED, 0.0, w))


@step_end("scheme trajectory", "creeping", named=("turn", "attitude"))
def TinyTurnsDropped(before: State, after: State, dt: float | Array) -> State:
    """A step that would turn the attitude by less than 1e-6 rad leaves it."""
    turn = norm(rotation_between(before.orientation, after.orientation))[..., None]
    q = np.where(turn < LEAST_TURN, before.orientation, after.orientation)
    return replace(after, orientation=q)


@fault_by(Spoiled, "logged", "logging", "trajectory", "free", named=("velocity", "position"))
def PositionOfTheSampleBefore(self: Spoiled, trajectory: Trajectory) -> Trajectory:
    """The position is that of the sample before."""
    state = trajectory.state
    late = np.concatenate([state.position[:1], state.position[:-1]])
    return replace(trajectory, state=replace(state, position=late))
