"""The motion of many lanes of parameters at once, at the samples of a trace.

All lanes share their steps, so that the difference of two lanes is as smooth as the motion, and a
derivative by differences is good to rounding over the step.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp

from omegadot.commands.fit.parameters import Parameters
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.system import Array

LEAST_MOMENT = 1e-6  # of the largest: below, a body spins up beyond any step


def motion(
    lanes: Parameters, torque: Array, times: Array, attitude: bool, tolerance: float, most: int
) -> tuple[Array, Array]:
    """The omega (k, n, 3), and orientation (k, n, 4) where it is requested, else (k, 0, 4).

    ``I w' = torque - damping w - w x (I w)`` and ``q' = q (0, w) / 2``, at times (n,) from the
    first sample on.  most: evaluations of the rates.  Raises ArithmeticError where a lane's motion
    leaves the range of numbers or needs more.
    """
    count = len(lanes.omega)
    if not all(np.all(np.isfinite(values)) for values in vars(lanes).values()):
        raise ArithmeticError("a number is not finite")
    moments = np.linalg.eigvalsh(lanes.inertia)
    if not np.all(moments[:, 0] > LEAST_MOMENT * moments[:, 2]):
        raise ArithmeticError("a moment of inertia vanishes")
    start = np.hstack([lanes.omega, lanes.orientation]) if attitude else lanes.omega
    slope = _slope(lanes, torque, attitude, most)
    with np.errstate(all="ignore"):  # what overflows is refused below
        done = solve_ivp(
            slope, (0.0, times[-1]), start.ravel(), "DOP853", times, rtol=tolerance, atol=tolerance
        )
    if not done.success or not np.all(np.isfinite(done.y)):
        raise ArithmeticError("the motion leaves the range of numbers")
    found = np.moveaxis(done.y.reshape(count, -1, len(times)), 2, 1)
    return found[..., :3], normalize(found[..., 3:]) if attitude else np.empty((count, 0, 4))


def _slope(
    lanes: Parameters, torque: Array, attitude: bool, most: int
) -> Callable[[float, Array], Array]:
    """The rates of all lanes, as SciPy takes them: one flat array."""
    calls = iter(range(most))
    count, inverse = len(lanes.omega), np.linalg.inv(lanes.inertia)
    damping, inertia = lanes.damping[:, None], lanes.inertia

    def slope(_: float, flat: Array) -> Array:
        if next(calls, None) is None:
            raise ArithmeticError("the motion is too fast to follow")
        y = flat.reshape(count, -1)
        w, rate = y[:, :3], np.empty_like(y)
        momentum = (inertia @ w[:, :, None])[:, :, 0]
        load = torque - damping * w - cross(w, momentum)
        rate[:, :3] = (inverse @ load[:, :, None])[:, :, 0]
        if attitude:
            s, v = y[:, 3:4], y[:, 4:]
            rate[:, 3] = -0.5 * np.sum(v * w, 1)
            rate[:, 4:] = 0.5 * (s * w + cross(v, w))
        return rate.ravel()

    return slope
