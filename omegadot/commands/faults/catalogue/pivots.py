"""Faults of pivoted bodies: where the pivot lies, and the inertia about it."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from omegadot.commands.faults.catalogue.load import extra_torque, other_load, pushed
from omegadot.commands.faults.fault import OtherSystem, fault_by
from omegadot.commands.faults.restepped import Accelerated
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever, moving_inertia, parallel_axis
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array, Load, State, System

pivoted = partial(fault_by, Accelerated, "changed", "equation", "equation", "pivot lever")
loaded = partial(fault_by, OtherSystem, "loaded", "equation", "equation")


def other_pivot(load: Load, kept: tuple[float, float, float]) -> Load:
    """The pivot with each component kept (1) or dropped (0)."""
    return replace(load, pivot=None if load.pivot is None else load.pivot * np.array(kept))


@other_load("pivot-off-origin", named="pivot")
def PivotXDropped(load: Load) -> Load:
    """The pivot's x is taken for zero."""
    return other_pivot(load, (0.0, 1.0, 1.0))


@other_load("pivot-off-origin", named="pivot")
def PivotOnZAlone(load: Load) -> Load:
    """The pivot is taken on the z axis alone."""
    return other_pivot(load, (0.0, 0.0, 1.0))


@loaded("pivot lever", named=("pivot", "centre of mass"))
def PivotBeyondCenter(self: OtherSystem, system: System) -> System:
    """The pivot lies beyond the centre of mass: the lever has the wrong sign."""
    load = system.load
    if load.pivot is None:
        return system
    return replace(system, load=replace(load, pivot=load.pivot + 2.0 * lever(system)))


@loaded("lever-negative", named=("pivot", "centre of mass"))
def LeverBySize(self: OtherSystem, system: System) -> System:
    """The lever's components are taken by size, as if it pointed along positive axes."""
    load = system.load
    if load.pivot is None:
        return system
    pivot = system.body.center_of_mass - np.abs(lever(system))
    return replace(system, load=replace(load, pivot=pivot))


@loaded("pivot offset", named=("centre of mass", "pivot"))
def CenterOfMassIgnoredOnPivots(self: OtherSystem, system: System) -> System:
    """A pivoted body's centre of mass is taken to be its origin."""
    if system.load.pivot is None:
        return system
    body = replace(system.body, center_of_mass=np.zeros(3))
    return replace(system, bodies=(body,))


def with_inertia(system: System, state: State, sound: Acceleration, tensor: Array) -> Acceleration:
    """The acceleration with another inertia about the pivot, under the same torque."""
    if system.load.pivot is None:
        return sound
    w, right = state.angular_velocity, moving_inertia(system)
    torque = apply(right, sound.angular) + cross(w, apply(right, w))
    angular = apply(inverse(tensor), torque - cross(w, apply(tensor, w)))
    return pushed(system, state, sound, apply(right, angular - sound.angular))


@pivoted(named="inertia")
def ParallelAxisDropped(self: Accelerated, state: State, sound: Acceleration) -> Acceleration:
    """A pivoted body turns with its inertia about the centre of mass."""
    return with_inertia(self.system, state, sound, self.system.body.inertia)


@pivoted(named="inertia")
def ParallelAxisDiagonal(self: Accelerated, state: State, sound: Acceleration) -> Acceleration:
    """The parallel-axis theorem changes the diagonal of the inertia alone."""
    body = self.system.body
    moved = np.diag(np.diag(parallel_axis(body.mass, lever(self.system))))
    return with_inertia(self.system, state, sound, body.inertia + moved)


@extra_torque("pivot lever", named=("gyroscopic", "inertia"))
def GyroscopicAboutCenter(system: System, state: State) -> Array:
    """A pivoted body's gyroscopic term is that of its inertia about the centre of mass."""
    w = state.angular_velocity
    return cross(w, apply(moving_inertia(system) - system.body.inertia, w))
