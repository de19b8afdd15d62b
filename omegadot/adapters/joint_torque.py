"""The applied torques and the damping of one body as a torque of its joint, in body axes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from omegadot.reference_impl.arithmetic.components import rotated
from omegadot.reference_impl.system import Array, Load

Torque = Callable[[Array, Array], Array]


def joint_torque(load: Load, count: int, *, scalar_last: bool) -> Array | Torque:
    """The torque (n,) of a joint of n velocities: constant, or of q and v.

    The last three velocities are omega in body axes; a couple has no linear part.
    scalar_last: the quaternion, with which q ends, is (x, y, z, w), not (w, x, y, z).
    """
    constant, drag = np.zeros(count), np.zeros(count)
    constant[-3:], drag[-3:] = load.torque_body, -load.damping
    world = [float(x) for x in load.torque_world]
    if not any(world):
        if not drag.any():
            return constant
        return (lambda _, v: constant + drag * v) if constant.any() else lambda _, v: drag * v

    def in_world(q: Array, _: Array) -> Array:
        a, b, c, d = q[-4:].tolist()
        inverse = (-d, a, b, c) if scalar_last else (-a, b, c, d)
        couple = constant.copy()
        couple[-3:] += rotated(inverse, world)
        return couple

    return (lambda q, v: in_world(q, v) + drag * v) if drag.any() else in_world
