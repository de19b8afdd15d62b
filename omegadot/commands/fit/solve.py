"""Nonlinear least squares of the motion on a trace, over a horizon that grows.

Over a long trace the error of a start's rates turns phases round, and the sum of squares has many
minima. Over a short one it has one. So the first few radians are fitted first, then more.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from scipy.optimize import OptimizeResult, least_squares

from omegadot.commands.fit.motion import motion
from omegadot.commands.fit.parameters import (
    Free,
    Parameters,
    factor_of,
    factored,
    inside,
    moved,
    tail_of,
)
from omegadot.reference_impl.rotations import rotation_between
from omegadot.reference_impl.system import Array

EPS = float(np.finfo(float).eps)
FIRST_TURN = 3.0  # rad, of the first horizon
GROWTH = 2.5  # of a horizon to the next
LEAST_SAMPLES = 8  # of a horizon
STEP = 1e-7  # of differences, of numbers of the order of one
MOST_RATES = 400  # evaluations a unit of time, about a radian: a tolerance of 1e-12 needs 60
CLOSE, TRIALS = 1e-4, 15  # where a search ends that goes on
CLOSEST, MOST_TRIALS = 1e-13, 60  # and the last
NO_MORE = 1e-6  # relative, of a cost: what rounding a body to one that can exist may add
FOLLOWED_TO = 1e-10  # rms, the same where there is no noise
RIDGE = 1e-6
FAR = 1e3  # a residual where there is no motion
TRIED = 4  # of the starts, over the first horizon
FOLLOWED = 2  # of the fits over the first horizon
SAME = 1e-2  # costs of one minimum differ by less
INSIDE = 1e-3  # the least second moment that a search within bodies starts from, of their sum


@dataclass(frozen=True)
class Data:
    """A trace in the units of the fit.

    times: (n,) from zero.  omega: (n, 3).  orientation: (n, 4), or None where it is not given.
    torque: (3,), body axes; zero where none is known.  turn_weight: that of a rad of attitude where
    one of omega is 1.  tolerance: relative, of the motion.  ridge: the weight of what pulls bias,
    damping and turn to zero.
    """

    times: Array
    omega: Array
    orientation: Array | None
    torque: Array
    turn_weight: float = 1.0
    tolerance: float = 1e-9
    ridge: float = RIDGE

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


def solve(
    data: Data, start: Parameters, free: Free, closeness: float = CLOSE, trials: int = TRIALS
) -> Fitted:
    """The least squares over the whole of `data` from one start.

    closeness: relative, of parameters and sum of squares where the search ends.
    """
    start = _released(start, free)
    lanes_of = partial(moved, start, free=free)
    x0 = np.zeros(free.count)
    found = _search(data, lanes_of, x0, tail_of(start, free)[3:], closeness, trials)
    one, cost = lanes_of(found.x), _of_data(found, free)
    if not free.shape:
        return Fitted(one, free, cost)
    flat = replace(one, inertia=inside(one.inertia, 0.0))
    if cost_of(data, flat, free) <= cost * (1.0 + NO_MORE) + data.omega.size * FOLLOWED_TO**2:
        return Fitted(flat, free, cost)
    one = replace(one, inertia=inside(one.inertia, INSIDE))  # a flat factor has no slope
    lanes_of, tail = partial(factored, one, free=free), np.zeros(free.tail)
    found = _search(data, lanes_of, factor_of(one, free), tail, closeness, trials)
    return Fitted(lanes_of(found.x), free, _of_data(found, free))


def _of_data(found: OptimizeResult, free: Free) -> float:
    """The sum of squares without what holds the rest."""
    return float(np.sum(found.fun[: len(found.fun) - free.tail] ** 2))


def _search(
    data: Data,
    lanes_of: Callable[[Array], Parameters],
    x0: Array,
    tail: Array,
    closeness: float,
    trials: int,
) -> OptimizeResult:
    """Levenberg and Marquardt's method, with the derivatives of all parameters in one motion."""
    known: dict[bytes, tuple[Array, Array]] = {}

    def both(x: Array) -> tuple[Array, Array]:
        if x.tobytes() not in known:
            known.clear()
            known[x.tobytes()] = _evaluate(data, lanes_of, x, tail)
        return known[x.tobytes()]

    return least_squares(
        lambda x: both(x)[0], x0, lambda x: both(x)[1], method="lm", x_scale="jac",
        xtol=closeness, ftol=closeness, gtol=EPS, max_nfev=trials,
    )  # fmt: skip


def _released(start: Parameters, free: Free) -> Parameters:
    """The start with what is not fitted at zero, and with a body that can exist, or a sphere."""
    bias = start.bias if free.bias else np.zeros(3)
    damping = start.damping if free.damping else np.zeros(())
    sphere = np.trace(start.inertia) / 3.0 * np.eye(3)
    inertia = inside(start.inertia, 0.0) if free.shape else sphere
    if not free.scale:
        inertia = 2.0 * inertia / np.trace(inertia)
    return replace(start, bias=bias, damping=damping, inertia=inertia)


def _evaluate(
    data: Data, lanes_of: Callable[[Array], Parameters], x: Array, tail: Array
) -> tuple[Array, Array]:
    """Residuals and their derivatives.

    With one more for each of bias, damping and turn, as a rule so weak that it matters only where
    the data give no hold.
    """
    steps = STEP * np.maximum(np.abs(x), 1.0)
    vectors = np.vstack([x, x + np.diag(steps)])
    try:
        left = data.residuals(lanes_of(vectors))
    except ArithmeticError:
        count = data.omega.size * (1 if data.orientation is None else 2) + len(tail)
        return np.full(count, FAR), np.zeros((count, len(x)))
    held = data.ridge * (vectors[:, len(x) - len(tail) :] + tail)
    left = np.hstack([left, held])
    return left[0], (left[1:] - left[0]).T / steps


def finish(data: Data, fit: Fitted, trials: int = MOST_TRIALS) -> Fitted:
    """The same minimum to the last digit."""
    return solve(data, fit.one, fit.free, CLOSEST, trials)


def follow(data: Data, starts: list[Parameters], free: Free) -> Fitted:
    """The least squares over horizons that grow to the whole, from the best of the starts.

    The nearest are fitted over the first horizon, and the best of these over the whole.
    """
    counts = _horizons(data)
    short = data.until(counts[0])
    near = sorted(starts, key=lambda one: cost_of(short, one, free))[:TRIED]
    found = sorted((solve(short, one, free) for one in near), key=lambda fit: fit.cost)
    ends = []
    for fit in _different(found)[:FOLLOWED]:
        for count in counts[1:]:
            fit = solve(data.until(count), fit.one, free)
        ends.append(fit)
    return min(ends, key=lambda fit: fit.cost)


def cost_of(data: Data, start: Parameters, free: Free) -> float:
    """The sum of squares of a start itself."""
    lane = moved(_released(start, free), np.zeros((1, free.count)), free)
    try:
        return float(np.sum(data.residuals(lane) ** 2))
    except ArithmeticError:
        return np.inf


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
