"""Nonlinear least squares of the motion on a trace, from one start."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from scipy.optimize import OptimizeResult, least_squares

from omegadot.commands.fit.data import Data
from omegadot.commands.fit.parameters import (
    Free,
    Parameters,
    factor_of,
    factored,
    inside,
    moved,
    tail_of,
)
from omegadot.reference_impl.system import Array

EPS = float(np.finfo(float).eps)
STEP = 1e-7  # of differences, of numbers of the order of one
CLOSE, TRIALS = 1e-4, 15  # where a search ends that goes on
CLOSEST, MOST_TRIALS = 1e-13, 60  # and the last
NO_MORE = 1e-6  # relative, of a cost: what rounding a body to one that can exist may add
FOLLOWED_TO = 1e-10  # rms, the same where there is no noise
FAR = 1e3  # a residual where there is no motion
INSIDE = 1e-3  # the least second moment that a search within bodies starts from, of their sum


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


def cost_of(data: Data, start: Parameters, free: Free) -> float:
    """The sum of squares of a start itself."""
    lane = moved(_released(start, free), np.zeros((1, free.count)), free)
    try:
        return float(np.sum(data.residuals(lane) ** 2))
    except ArithmeticError:
        return np.inf
