"""Pinocchio's own `aba` and `integrate` as a motion that the reference's schemes step.

Nothing but calls of Pinocchio is in the loop where no load depends on the state. Coordinates are
Pinocchio's: a free flyer's q is (position, x, y, z, w) and its v the spatial velocity (linear,
angular) in body axes; a spherical joint's are (x, y, z, w) and omega.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from omegadot.adapters.joint_torque import joint_torque
from omegadot.reference_impl.arithmetic.components import rotated
from omegadot.reference_impl.one_body.body_configurations import ATTITUDE, SPATIAL
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.system import Array, Load


def joint_motion(pin: Any, model: Any, load: Load) -> Motion:
    """The joint's motion under its loads."""
    data, torque = model.createData(), joint_torque(load, model.nv, scalar_last=True)
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
