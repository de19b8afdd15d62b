"""The covariance of a fit, and of what follows from it.

``C = (J^T J / (s^2 f) + P)^-1`` with the derivatives J of the motion by the parameters, the noise s
of a component and the inflation f of correlated residuals. P is the knowledge without any data: a
moment lies within the size of the body, a bias within that of omega. It is negligible where the
data determine a number, and where they do not, the standard error comes out as large as that range.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.special import ndtr, stdtrit

from omegadot.commands.fit.data import Data
from omegadot.commands.fit.noise import Noise
from omegadot.commands.fit.parameters import Free, Parameters, moved
from omegadot.commands.fit.solve import Fitted
from omegadot.reference_impl.system import Array

STEP = 1e-5  # of central differences, of numbers of the order of one: rounding and curve are alike
RESOLVED = 1e-7  # relative, of derivatives by differences
FAR = 4.0  # standard errors
RANGE = 1.0  # in the units of the fit: of omega, bias, damping and moments without any data
TURN_RANGE = np.pi  # of the attitude
SCALE_RANGE = 10.0  # of the inertia where it has a scale, of its size


@dataclass(frozen=True)
class Spread:
    """A fit with its covariance. directions: (k, 3, 3), of the inertia; the first k parameters."""

    one: Parameters
    free: Free
    covariance: Array
    directions: Array

    def error(self, slopes: Array) -> Array:
        """(...,) standard errors of numbers by their derivatives, (..., m)."""
        variance = np.einsum("...i,ij,...j->...", slopes, self.covariance, slopes)
        return np.asarray(np.sqrt(np.maximum(variance, 0.0)))

    def slope_of_entry(self, left: Array, right: Array) -> Array:
        """(m,): of ``left . I right`` by the parameters."""
        slopes = np.zeros(len(self.covariance))
        slopes[: len(self.directions)] = np.einsum("i,kij,j->k", left, self.directions, right)
        return slopes

    def places(self, name: str) -> slice:
        """Where omega, bias, damping or orientation stand among the parameters."""
        at = len(self.directions)
        sizes = {"omega": 3, "bias": 3 * self.free.bias, "damping": int(self.free.damping)}
        for known, size in (*sizes.items(), ("orientation", 3 * self.free.orientation)):
            if known == name:
                return slice(at, at + size)
            at += size
        raise KeyError(name)

    def slopes_of(self, name: str) -> Array:
        """(size, m): of omega, bias, damping or orientation itself."""
        return np.eye(len(self.covariance))[self.places(name)]


def spread_of(data: Data, fit: Fitted, noise: Noise, free: Free | None = None) -> Spread:
    """The covariance of a fit that leaves this noise.

    free: what is open, which may be more than was fitted: a term that is zero in the fit, but need
    not be so in the body or the gyro, widens the rest as any other.
    """
    fit = fit if free is None else replace(fit, free=free)
    directions = fit.free.directions(fit.one.inertia)
    count = fit.free.count
    # A body at the limit of what can exist is moved beyond it: the equations allow that, as long
    # as no moment vanishes.
    step = min(STEP, 0.1 * float(np.linalg.eigvalsh(fit.one.inertia)[0]))
    lanes = moved(fit.one, step * np.vstack([np.eye(count), -np.eye(count)]), fit.free)
    try:
        left = data.residuals(lanes)
    except ArithmeticError:  # beside it there is no motion: it shows nothing
        left = np.zeros((2 * count, data.omega.size))
    slopes = (left[:count] - left[count:]) / (2.0 * step)
    slopes /= noise.omega * np.sqrt(noise.inflation) * _of_few(left.shape[1] - count)
    size = float(np.linalg.norm(fit.one.inertia))
    ranges = np.full(count, RANGE)
    ranges[count - 3 * fit.free.orientation :] = TURN_RANGE
    if fit.free.scale:
        ranges[: len(directions)] = SCALE_RANGE * size
        ranges[count - 3 * fit.free.orientation - fit.free.damping :][: fit.free.damping] *= size
    return Spread(fit.one, fit.free, _covariance(slopes, ranges), directions)


def _of_few(spare: int) -> float:
    """By how much an error grows where its size is estimated from few residuals.

    By Student's t: FAR standard errors then hold with the probability of a normal distribution.
    """
    return float(-stdtrit(max(spare, 1), ndtr(-FAR)) / FAR)


def _covariance(slopes: Array, ranges: Array) -> Array:
    """``(J^T J + diag(1 / ranges^2))^-1``; slopes: (m, n), J's columns over the noise.

    By singular values, in units of the ranges. One that the differences do not resolve is none.
    """
    vectors, sizes, _ = np.linalg.svd(slopes * ranges[:, None], full_matrices=False)
    held = np.maximum(sizes**2 - (RESOLVED * sizes[0]) ** 2, 0.0) + 1.0
    return np.asarray((vectors / held) @ vectors.T * np.outer(ranges, ranges))
