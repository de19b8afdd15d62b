"""biorbd's own `ForwardDynamics` as a motion that the reference's schemes step.

Coordinates are the reference's: q is (position, w, x, y, z) and v the spatial velocity (linear,
angular) in body axes of a free body; of a pivoted one they are (w, x, y, z) and omega. Those of
biorbd are (position, x, y, z, w), and the velocity of the origin in world axes before omega.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from omegadot.adapters.joint_torque import joint_torque
from omegadot.reference_impl.arithmetic.components import rotated
from omegadot.reference_impl.one_body.body_configurations import ATTITUDE, SPATIAL
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.schemes.motion import Velocity
from omegadot.reference_impl.system import Array, Load


def body_motion(model: Any, load: Load) -> Motion:
    """The body's motion under its loads; damping is the model's own."""
    parts = SPATIAL if load.pivot is None else ATTITUDE
    return Motion(acceleration=_forward(model, load), **parts)


def own_coordinates(q: Array, v: Array) -> tuple[Array, Array, tuple[float, ...]]:
    """Those of biorbd, and the unit quaternion (w, x, y, z): it takes no others."""
    *place, w, x, y, z = q.tolist()
    length = math.sqrt(w * w + x * x + y * y + z * z)
    w, x, y, z = w / length, x / length, y / length, z / length
    *linear, a, b, c = v.tolist()
    if place:
        linear = [*rotated((w, x, y, z), linear)]
    return np.array([*place, x, y, z, w]), np.array([*linear, a, b, c]), (w, x, y, z)


def _forward(model: Any, load: Load) -> Velocity:
    """``v̇`` by `ForwardDynamics`, of which the acceleration of the origin is in world axes.

    In body axes it is ``R^T a - ω x u``, u the velocity of the origin there. What it answers is as
    long as q, and its last number is none of them.
    """
    forward, free = model.ForwardDynamics, load.pivot is None
    count = 6 if free else 3
    torque = joint_torque(replace(load, damping=np.array(0.0)), count, scalar_last=False)

    def acceleration(q: Array, v: Array) -> Array:
        own_q, own_v, unit = own_coordinates(q, v)
        applied = torque(np.array(unit), v) if callable(torque) else torque
        found: Array = forward(own_q, own_v, applied).to_array()[:count]
        if not free:
            return found
        w, x, y, z = unit
        a, b, c, *angular = found.tolist()
        a, b, c = rotated((-w, x, y, z), (a, b, c))
        i, j, k, d, e, f = v.tolist()
        return np.array([a - e * k + f * j, b - f * i + d * k, c - d * j + e * i, *angular])

    return acceleration
