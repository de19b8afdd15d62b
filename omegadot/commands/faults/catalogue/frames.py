"""Faults of turning between body and world: of the inertia, of a torque, of a place."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from omegadot.commands.faults.catalogue.convention import Misread
from omegadot.commands.faults.catalogue.equation import gyroscopic_term
from omegadot.commands.faults.catalogue.load import extra_torque
from omegadot.commands.faults.fault import Spoiled, fault_by
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.kinematics import point_position
from omegadot.reference_impl.loads import torque
from omegadot.reference_impl.rotations import quaternion_product, rotate, rotate_inverse
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Array, State, System

misread = partial(fault_by, Misread, "reported", "convention", "model")


@extra_torque("asymmetric", named="the inertia in world axes is R^T I R, where R I R^T was due")
def InertiaTurnedBackwards(system: System, state: State) -> Array:
    """The inertia is turned into world axes as ``R^T I R`` instead of ``R I R^T``."""
    tensor, w = moving_inertia(system), state.angular_velocity
    twice = quaternion_product(state.orientation, state.orientation)  # R^T J R is of R R

    def turned(by: Array, vector: Array) -> Array:
        return rotate_inverse(twice, apply(by, rotate(twice, vector)))

    wrong = turned(inverse(tensor), torque(system, state) - cross(w, turned(tensor, w)))
    return apply(tensor, wrong) - (torque(system, state) - gyroscopic_term(system, state))


@extra_torque("torque-world", named="is its heading alone: roll and pitch are left out")
def WorldTorqueByHeading(system: System, state: State) -> Array:
    """A torque in world axes is turned into the body by the heading alone."""
    w, x, y, z = np.moveaxis(state.orientation, -1, 0)
    half = 0.5 * np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
    heading = np.stack([np.cos(half), 0.0 * half, 0.0 * half, np.sin(half)], axis=-1)
    couple = system.load.torque_world
    return rotate_inverse(heading, couple) - rotate_inverse(state.orientation, couple)


@misread("pivot-off-origin", named="the position is R c")
def PivotedPlaceFromOrigin(self: Spoiled, state: State) -> State:
    """The place of a pivoted body is reported from its origin, as ``R c``, not from the pivot."""
    pivot = self.system.load.pivot
    if pivot is None:
        return state
    return replace(state, position=point_position(state, pivot))
