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

CROSS = cross(np.eye(3)[:, None], np.eye(3))  # e_j x e_l
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
    count, terms = len(lanes.omega), _terms(lanes, attitude)
    size = terms.shape[1]
    constant = np.zeros((count, size, 1))
    constant[:, :3] = np.linalg.inv(lanes.inertia) @ np.broadcast_to(torque, (count, 3))[..., None]
    omega_and_one = np.ones((count, 1, 4))

    def slope(_: float, flat: Array) -> Array:
        if next(calls, None) is None:
            raise ArithmeticError("the motion is too fast to follow")
        y = flat.reshape(count, size, 1)
        omega_and_one[:, 0, :3] = y[:, :3, 0]
        products = (y * omega_and_one).reshape(count, 4 * size, 1)
        return (terms @ products + constant).ravel()

    return slope


def _terms(lanes: Parameters, attitude: bool) -> Array:
    """The rates' coefficients (k, m, 4 m) of the products of each number of a state with omega, 1.

    Equation (8) and ``q' = q (0, w) / 2`` are sums of such products, and a sum of all of them is
    one product of a matrix: over a few lanes the calls are what takes time, not the arithmetic.
    """
    size = 7 if attitude else 3
    terms = np.zeros((len(lanes.omega), size, size, 4))  # rate, number, omega's component or 1
    inverse = np.linalg.inv(lanes.inertia)
    terms[:, :3, :3, :3] = -np.einsum("nra,jla,nlk->nrjk", inverse, CROSS, lanes.inertia)
    terms[:, :3, :3, 3] = -lanes.damping[:, None, None] * inverse
    if attitude:
        terms[:, 3, 4:, :3] = -0.5 * np.eye(3)
        terms[:, 4:, 3, :3] = 0.5 * np.eye(3)
        terms[:, 4:, 4:, :3] = 0.5 * np.moveaxis(CROSS, 2, 0)
    return terms.reshape(len(lanes.omega), size, 4 * size)
