"""Nonlinear least squares of the motion on a trace, over a horizon that grows.

Over a long trace the error of a start's rates turns phases round, and the sum of squares has many
minima. Over a short one it has one. So the first few radians are fitted first, then more.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import least_squares

from omegadot.commands.fit.motion import motion
from omegadot.commands.fit.parameters import Free, Parameters, inside, parameters_of, vector_of
from omegadot.reference_impl.rotations import rotation_between
from omegadot.reference_impl.system import Array

EPS = float(np.finfo(float).eps)
FIRST_TURN = 3.0  # rad, of the first horizon
GROWTH = 2.5  # of a horizon to the next
LEAST_SAMPLES = 8  # of a horizon
STEP = 1e-7  # of differences, of numbers of the order of one
MOST_RATES = 400  # evaluations a unit of time, about a radian: a tolerance of 1e-12 needs 60
CLOSE, CLOSEST = 1e-4, 1e-13  # where a search ends: one that goes on, and the last
TRIALS, MOST_TRIALS = 15, 60  # of the same
RIDGE = 1e-6
FAR = 1e3  # a residual where there is no motion
FOLLOWED = 2  # of the fits over the first horizon
SAME = 1e-2  # costs of one minimum differ by less
INSIDE = 1e-3  # the factor of a flat body has no slope out of the plane: start above it


@dataclass(frozen=True)
class Data:
    """A trace in the units of the fit.

    times: (n,) from zero.  omega: (n, 3).  orientation: (n, 4), or None where it is not given.
    torque: (3,), body axes; zero where none is known.  turn_weight: that of a rad of attitude where
    one of omega is 1.  tolerance: relative, of the motion.
    """

    times: Array
    omega: Array
    orientation: Array | None
    torque: Array
    turn_weight: float = 1.0
    tolerance: float = 1e-9

    def until(self, count: int) -> Data:
        """The first samples alone."""
        turned = None if self.orientation is None else self.orientation[:count]
        return replace(self, times=self.times[:count], omega=self.omega[:count], orientation=turned)

    @property
    def turned(self) -> Array:
        """(n,) rad, by how much the body has turned."""
        speed = np.linalg.norm(self.omega, axis=1)
        steps = 0.5 * (speed[1:] + speed[:-1]) * np.diff(self.times)
        return np.concatenate(([0.0], np.cumsum(steps)))

    def residuals(self, lanes: Parameters) -> Array:
        """(k, 3n) or (k, 6n): what the motion of each lane leaves of omega, then of attitude."""
        turning = self.orientation is not None
        most = int(MOST_RATES * (1.0 + self.times[-1]))
        omega, orientation = motion(lanes, self.torque, self.times, turning, self.tolerance, most)
        count = len(omega)
        left = (self.omega - omega - lanes.bias[:, None]).reshape(count, -1)
        if self.orientation is None:
            return left
        turns = rotation_between(orientation, np.broadcast_to(self.orientation, orientation.shape))
        return np.hstack([left, self.turn_weight * turns.reshape(count, -1)])


@dataclass(frozen=True)
class Fitted:
    """A fit. cost: the sum of squares, of the units of the fit."""

    one: Parameters
    free: Free
    cost: float


def solve(data: Data, start: Parameters, free: Free, last: bool = False) -> Fitted:
    """The least squares over the whole of `data` from one start.

    last: to the last digit, where a search goes on from what was found otherwise.
    """
    closeness, trials = (CLOSEST, MOST_TRIALS) if last else (CLOSE, TRIALS)
    start = _released(start, free)
    known: dict[bytes, tuple[Array, Array]] = {}

    def both(x: Array) -> tuple[Array, Array]:
        if x.tobytes() not in known:
            known.clear()
            known[x.tobytes()] = _evaluate(data, x, free, start)
        return known[x.tobytes()]

    x0 = vector_of(start, free)
    if len(both(x0)[0]) < len(x0):
        raise ValueError("fewer numbers than parameters")
    done = least_squares(
        lambda x: both(x)[0], x0, lambda x: both(x)[1],
        method="lm", xtol=closeness, ftol=closeness, gtol=EPS, max_nfev=trials,
    )  # fmt: skip
    return Fitted(parameters_of(done.x, free, start), free, 2.0 * float(done.cost))


def _released(start: Parameters, free: Free) -> Parameters:
    """The start with what is not fitted at zero, and the body not flat, or a sphere."""
    bias = start.bias if free.bias else np.zeros(3)
    damping = start.damping if free.damping else np.zeros(())
    sphere = np.trace(start.inertia) / 3.0 * np.eye(3)
    inertia = inside(start.inertia, INSIDE) if free.shape else sphere
    return replace(start, bias=bias, damping=damping, inertia=inertia)


def _evaluate(data: Data, x: Array, free: Free, base: Parameters) -> tuple[Array, Array]:
    """Residuals and their derivatives.

    With one more that holds the trace of the inertia at 2 where nothing gives it a scale, and one
    for each of bias, damping and turn, so weak that it matters only where the data give no hold.
    """
    gauge, tail = free.shape and not free.scale, free.tail
    vectors = np.vstack([x, x + STEP * np.eye(len(x))])
    try:
        left = data.residuals(parameters_of(vectors, free, base))
    except ArithmeticError:
        count = data.omega.size * (1 if data.orientation is None else 2) + tail + gauge
        return np.full(count, FAR), np.zeros((count, len(x)))
    left = np.hstack([left, RIDGE * vectors[:, len(x) - tail :]])
    if gauge:
        left = np.hstack([left, np.sum(vectors[:, :6] ** 2, 1)[:, None] - 1.0])
    return left[0], (left[1:] - left[0]).T / STEP


def follow(data: Data, starts: list[Parameters], free: Free) -> Fitted:
    """The least squares over horizons that grow to the whole, from the best of the starts.

    All are fitted over the first horizon, and the best few over the whole.
    """
    counts = _horizons(data)
    short = data.until(counts[0])
    found = sorted((solve(short, one, free) for one in starts), key=lambda fit: fit.cost)
    ends = []
    for fit in _different(found)[:FOLLOWED]:
        for count in counts[1:]:
            fit = solve(data.until(count), fit.one, free)
        ends.append(fit)
    return min(ends, key=lambda fit: fit.cost)


def _horizons(data: Data) -> list[int]:
    """How many samples each horizon has, the whole last."""
    turned, whole = data.turned, len(data.times)
    counts, reach = [], FIRST_TURN
    while reach < turned[-1] / np.sqrt(GROWTH):
        count = max(int(np.searchsorted(turned, reach)), LEAST_SAMPLES)
        if count < whole and count not in counts:
            counts.append(count)
        reach *= GROWTH
    return [*counts, whole]


def _different(fits: list[Fitted]) -> list[Fitted]:
    """Those in rising order that are not one minimum again."""
    kept: list[Fitted] = []
    for fit in fits:
        if not any(abs(fit.cost - other.cost) <= SAME * fit.cost for other in kept):
            kept.append(fit)
    return kept
