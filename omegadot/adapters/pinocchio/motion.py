"""Pinocchio's own `aba` and `integrate` as a motion that the reference's schemes step.

Nothing but calls of Pinocchio is in the loop where no load depends on the state. Coordinates are
Pinocchio's: a free flyer's q is (position, x, y, z, w) and its v the spatial velocity (linear,
angular) in body axes; a spherical joint's are (x, y, z, w) and omega.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from omegadot.reference_impl.arithmetic.components import rotated
from omegadot.reference_impl.one_body.body_configurations import ATTITUDE, SPATIAL
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.system import Array, Load

Torque = Callable[[Array, Array], Array]


def joint_torque(load: Load, count: int) -> Array | Torque:
    """The applied torques and the damping as a torque (n,) of the joint: constant, or of q and v.

    A couple has no linear part.
    """
    constant, drag = np.zeros(count), np.zeros(count)
    constant[-3:], drag[-3:] = load.torque_body, -load.damping
    world = [float(x) for x in load.torque_world]
    if not any(world):
        if not drag.any():
            return constant
        return (lambda _, v: constant + drag * v) if constant.any() else lambda _, v: drag * v

    def in_world(q: Array, _: Array) -> Array:
        *_, x, y, z, w = q.tolist()
        couple = constant.copy()
        couple[-3:] += rotated((-w, x, y, z), world)
        return couple

    return (lambda q, v: in_world(q, v) + drag * v) if drag.any() else in_world


def joint_motion(pin: Any, model: Any, load: Load) -> Motion:
    """The joint's motion under its loads."""
    data, torque = model.createData(), joint_torque(load, model.nv)
    parts = {**(SPATIAL if load.pivot is None else ATTITUDE), "turned_by": None}
    parts["retract"] = partial(pin.integrate, model)
    parts["normalize"] = partial(pin.normalize, model)
    parts["coordinate_rate"] = _coordinate_rate
    aba, damping = pin.aba, float(load.damping)

    def derivatives(q: Array, v: Array, torque: Any) -> Any:
        """Pinocchio's, of the body at the world's origin: it works them out about that point, and
        of a body far from it loses digits. They do not depend on the place.
        """
        if load.pivot is None:
            q = q.copy()
            q[:3] = 0.0
        return pin.computeABADerivatives(model, data, q, v, torque)

    def steady(q: Array, v: Array) -> Array:
        found: Array = aba(model, data, q, v, torque)
        return found

    def steady_jacobian(q: Array, v: Array, _: Array | None) -> tuple[Array, Array]:
        by_v: Array = derivatives(q, v, torque)[1]
        return data.ddq, by_v

    if not callable(torque):
        return Motion(acceleration=steady, jacobian=steady_jacobian, **parts)

    def acceleration(q: Array, v: Array) -> Array:
        found: Array = aba(model, data, q, v, torque(q, v))
        return found

    def jacobian(q: Array, v: Array, _: Array | None) -> tuple[Array, Array]:
        _, by_v, inverse_mass = derivatives(q, v, torque(q, v))
        if damping:
            by_v = by_v.copy()
            by_v[:, -3:] -= damping * inverse_mass[:, -3:]
        return data.ddq, by_v

    return Motion(acceleration=acceleration, jacobian=jacobian, **parts)


def _coordinate_rate(q: Array, v: Array) -> Array:
    """``(R u, ½ q (0, ω))`` in Pinocchio's order, R at the direction of q."""
    *place, x, y, z, w = q.tolist()
    *linear, a, b, c = v.tolist()
    a, b, c = 0.5 * a, 0.5 * b, 0.5 * c
    if place:
        linear = [*rotated((w, x, y, z), linear, 2 / (w * w + x * x + y * y + z * z))]
    turning = (
        w * a + y * c - z * b,
        w * b - x * c + z * a,
        w * c + x * b - y * a,
        -x * a - y * b - z * c,
    )
    return np.array([*linear, *turning])
