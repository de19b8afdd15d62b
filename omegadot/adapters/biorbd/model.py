"""A system as a biorbd model of one segment, its joint at the body's origin or at the pivot.

A free segment has three translations in world axes and a quaternion, a pivoted one a quaternion.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.body_files import NAME, origin_at_pivot
from omegadot.reference_impl.system import Body, System

SEGMENT = 0
QUATERNION = "q"


def build_model(engine: Any, system: System, *, damped: bool) -> Any:
    """The model under gravity; damped: with the system's damping as that of its joint."""
    body, load = system.body, system.load
    free = load.pivot is None
    lever = np.array(body.center_of_mass, float) - origin_at_pivot(system)
    inertia = np.array(body.inertia, float).ravel().tolist()
    held = engine.SegmentCharacteristics(
        float(body.mass), engine.Vector3d(*lever.tolist()), engine.Matrix3d(*inertia)
    )
    damping = engine.VecBiorbdScalar()
    for value in [0.0] * (3 if free else 0) + [float(load.damping) if damped else 0.0] * 3:
        damping.append(value)
    none, place = engine.VecBiorbdRange(), engine.RotoTrans()
    model = engine.Model()
    moves = ("xyz" if free else "", QUATERNION)
    model.AddSegment(NAME, "root", *moves, none, none, none, damping, held, place)
    model.setGravity(np.array(load.gravity, float))
    return model


def read_back(model: Any) -> Body:
    """Mass, centre of mass from the joint, and inertia about it, as the model holds them."""
    held = model.segment(SEGMENT).characteristics()
    center, inertia = held.CoM().to_array(), held.inertia().to_array()
    return Body(np.array(held.mass(), float), np.array(center), np.array(inertia))
