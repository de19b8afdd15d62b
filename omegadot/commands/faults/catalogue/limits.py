"""Faults of limits: what engines cap, clamp or hold up, at sizes that engines use."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from omegadot.commands.faults.catalogue.equation import gyroscopic_term
from omegadot.commands.faults.catalogue.load import extra_torque, other_load
from omegadot.commands.faults.catalogue.model import UnseenBody
from omegadot.commands.faults.catalogue.stepping import step_end
from omegadot.commands.faults.fault import fault_by
from omegadot.commands.faults.features import HEAVY, LIGHT, SMALL_INERTIA
from omegadot.diagnosis.stepping import step_ends
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.loads import applied_torque
from omegadot.reference_impl.rotations import rotation_between, turn_in_body
from omegadot.reference_impl.system import Array, Body, Load, State, System

ARMATURE = 1e-3  # kg m^2
MOST_TURN = 0.12  # rad
LEAST_TORQUE = -0.25  # N m, of a component
Enter = Callable[[Callable[..., Any]], Callable[..., Any]]


def sized(enter: Enter, name: str, sentence: str, function: Callable[..., Any]) -> None:
    """Enter a function made for one size, under a name and a sentence of its own."""
    function.__name__, function.__doc__, function.__module__ = name, sentence, __name__
    enter(function)


def speed_below(most: float) -> step_ends.End:
    """The linear velocity is scaled down to a speed in m/s."""

    def end(before: State, after: State, dt: float | Array) -> State:
        speed = np.maximum(norm(after.linear_velocity), 1e-300)[..., None]
        held = np.where(speed > most, most / speed, 1.0) * after.linear_velocity
        return replace(after, linear_velocity=held)

    return end


def turned_within(most: float) -> step_ends.End:
    """The attitude turns by this angle in rad at most, about the axis of its turn."""

    def end(before: State, after: State, dt: float | Array) -> State:
        turn = rotation_between(before.orientation, after.orientation)
        angle = np.maximum(norm(turn), 1e-300)[..., None]
        held = turn_in_body(before.orientation, turn * (most / angle), 1.0)
        return replace(after, orientation=np.where(angle > most, held, after.orientation))

    return end


for rate in (7, 25, 47, 100):
    omega = step_end("scheme", f"omega-above-{rate}", named=("omega is held", "omega is cap"))
    sentence = f"omega is held below {rate} rad/s."
    sized(omega, f"OmegaHeldBelow{rate}", sentence, step_ends.held_below(rate))

for speed in (100, 300):
    held = step_end("scheme", f"speed-above-{speed}", named=("linear velocity", "speed"))
    sentence = f"The speed is held below {speed} m/s."
    sized(held, f"SpeedHeldBelow{speed}", sentence, speed_below(speed))

turn = step_end("scheme", f"turn-above-{MOST_TURN:.2f}", named=("turn", "attitude"))
sentence = f"The attitude turns by {MOST_TURN:.2f} rad in a step at most."
sized(turn, "TurnHeld", sentence, turned_within(MOST_TURN))


@other_load("damping-above-1", named="damping")
def DampingClamped(load: Load) -> Load:
    """A damping above 1 N m s/rad is taken for 1."""
    return replace(load, damping=np.minimum(load.damping, 1.0))


@other_load("torque-below-clamp", named="torque")
def TorqueClampedBelow(load: Load) -> Load:
    """A component of an applied torque below -0.25 N m is taken for -0.25 N m."""
    body, world = (np.maximum(t, LEAST_TORQUE) for t in (load.torque_body, load.torque_world))
    return replace(load, torque_body=body, torque_world=world)


@extra_torque("asymmetric above-100-kg", named=("gyroscopic", "mass"))
def GyroscopicOffWhenHeavy(system: System, state: State) -> Array:
    """The gyroscopic term is 1 % too large for bodies above 100 kg."""
    share = -0.01 if system.body.mass > HEAVY else 0.0
    return share * gyroscopic_term(system, state)


@extra_torque("torque below-10-g", named=("torque", "mass"))
def TorqueLostWhenLight(system: System, state: State) -> Array:
    """Applied torques do not act on bodies below 0.01 kg."""
    share = -1.0 if system.body.mass < LIGHT else 0.0
    return share * applied_torque(system, state)


unseen_body = {"named": ("inertia", "diagonal")}


@fault_by(UnseenBody, "body", "model", "equation", "small-inertia", **unseen_body)
def InertiaHeldUp(body: Body) -> Body:
    """Principal moments below 1e-3 kg m^2 are taken for 1e-3 kg m^2."""
    moments, axes = np.linalg.eigh(body.inertia)
    return replace(body, inertia=axes @ np.diag(np.maximum(moments, SMALL_INERTIA)) @ axes.T)


@fault_by(UnseenBody, "body", "model", "equation", "asymmetric", **unseen_body)
def ArmatureAdded(body: Body) -> Body:
    """An armature of 1e-3 kg m^2 is added to the diagonal of the inertia in the dynamics."""
    return replace(body, inertia=body.inertia + ARMATURE * np.eye(3))
