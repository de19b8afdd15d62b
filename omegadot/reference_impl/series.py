"""The exact motion by its Taylor series: the truth where no closed form exists.

The equations are quadratic, so each coefficient of the solution follows from the earlier ones by
one convolution. Everything runs in long double: 64 bits of mantissa on x86, where what is left of
rounding, 1e-19 a step, is far below a double's. Where long double is a double (Windows, Apple's
ARM) the same code runs with double's rounding, a few 1e-16 a step; where it has 113 bits, with
more orders.

Method: Jorba and Zou, A software package for the numerical integration of ODEs by means of
high-order Taylor methods, Experimental Mathematics 14 (2005) 99-117.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import DTypeLike, NDArray

from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.precision import cast, extended
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.series_equations import Equations, G, Q, T, W, equations_of
from omegadot.reference_impl.system import Array, State, System

EPS = np.finfo(np.longdouble).eps
# Optimal is about -ln(eps)/2, 22 for a 64-bit mantissa; a little more costs little and gives
# longer steps, which dense output over few samples likes.
ORDER = int(-0.6 * np.log(EPS)) + 2


@dataclass(frozen=True)
class Segment:
    """One step: x(start + s) = Σ_k coefficients[..., k] s^k for s between 0 and `length`."""

    start: np.longdouble
    length: np.longdouble
    coefficients: Array

    def at(self, s: Array) -> Array:
        """The x at (n,) times after the start, (n, lanes, 13), by Horner's rule."""
        s = s[:, None, None]
        value = np.zeros((len(s), *self.coefficients.shape[:-1]), np.longdouble)
        for k in range(ORDER, -1, -1):
            value = value * s + self.coefficients[..., k]
        return value


def taylor_coefficients(equations: Equations, x: Array) -> Array:
    """Coefficients 0 to ORDER of the solution through x: (lanes, 13) to (lanes, 13, ORDER + 1).

    ``(k + 1) x_{k+1} = Σ_{j<=k} quadratic(x_j, ω_{k-j}) + linear(x_k) + constant [k = 0]``.
    """
    lanes = len(x)
    series = np.zeros((lanes, 13, ORDER + 1), np.longdouble)
    backwards = np.zeros((lanes, ORDER + 1, 3), np.longdouble)  # ω_k stands at ORDER - k
    table = equations.quadratic.reshape(39, 13)
    series[..., 0] = x
    for k in range(ORDER):
        backwards[:, ORDER - k] = series[:, W, k]
        products = series[..., : k + 1] @ backwards[:, ORDER - k :]
        rate = products.reshape(lanes, 39) @ table + series[..., k] @ equations.linear
        if k == 0:
            rate = rate + equations.constant
        series[..., k + 1] = rate / (k + 1)
    return series


def _step_length(series: Array) -> np.longdouble:
    """The step at which the last two terms are as small as rounding, the least over the lanes.

    Each of q, ω, g and t is measured by its own size; ω by ``max(|ω|, |ω̇|^½)``, which has a size
    at rest too. Infinite where the last terms vanish: the solution is a polynomial.
    """
    longest = np.longdouble(np.inf)
    for part in (Q, W, G, T):
        size = np.sqrt(np.add.reduce(series[:, part] ** 2, 1))  # (lanes, ORDER + 1)
        scale = size[:, 0]
        if part is W:
            scale = np.maximum(scale, np.sqrt(size[:, 1]))
        for k in (ORDER - 1, ORDER):
            moving = size[:, k] > 0
            if np.any(moving):
                ratio = EPS * scale[moving] / size[moving, k]
                longest = min(longest, np.min(ratio) ** (np.longdouble(1) / k))
    return longest


def _segments(equations: Equations, x: Array, end: np.longdouble) -> Iterator[Segment]:
    """Steps from time zero to `end`, which may be negative."""
    start, sign = np.longdouble(0), np.sign(end)
    while True:
        series = taylor_coefficients(equations, x)
        length = _step_length(series)
        left = abs(end - start)
        if length >= left:
            yield Segment(start, sign * left, series)
            return
        if not length > EPS * abs(start):
            raise ArithmeticError("the motion leaves the range of numbers")
        segment = Segment(start, sign * length, series)
        yield segment
        x = equations.refreshed(segment.at(np.array([segment.length]))[0])
        start = start + segment.length


def _fill(
    equations: Equations, x0: Array, times: Array, which: NDArray[np.intp], found: Array
) -> None:
    """Put x at ``times[which]``, all of one sign and sorted outwards from zero, into `found`."""
    if not len(which):
        return
    ahead = np.abs(times[which])
    first = 0
    for segment in _segments(equations, x0, times[which[-1]]):
        last = first + np.searchsorted(ahead[first:], abs(segment.start + segment.length), "right")
        inside = which[first:last]
        if len(inside):
            found[inside] = segment.at(times[inside] - segment.start)
        first = int(last)
    found[which[first:]] = segment.at(times[which[first:]] - segment.start)


def solve_series(
    system: System, initial: State, times: Array, dtype: DTypeLike = np.float64
) -> State:
    """The state at `times`, (n,) s in any order and of either sign; `initial` holds at zero.

    Leading axes of `initial` are lanes, which share their steps: the result has (n, lanes, ...).
    dtype: the type of the result, ``np.longdouble`` keeps all digits. Raises ValueError for a
    system with leading axes or a state or time that is not finite.
    """
    seconds = np.asarray(times, np.longdouble)
    fields = (initial.orientation, initial.angular_velocity, seconds)
    if seconds.ndim != 1 or not all(np.all(np.isfinite(field)) for field in fields):
        raise ValueError("the times are to be a list, and they and the state finite")
    equations = equations_of(system)
    equations = equations.in_own_time(equations.unknown(initial))
    x0, moments = equations.unknown(initial), seconds / equations.unit
    lanes, flat = x0.shape[:-1], x0.reshape(-1, 13)
    found = np.empty((len(moments), *flat.shape), np.longdouble)
    order = np.argsort(moments, kind="stable")
    split = int(np.searchsorted(moments[order], 0))
    _fill(equations, flat, moments, order[split:], found)
    _fill(equations, flat, moments, order[:split][::-1], found)
    x = found.reshape(len(moments), *lanes, 13)
    state = _translated(
        system, initial, seconds, normalize(x[..., Q]), equations.angular_velocity(x)
    )
    return cast(state, dtype)


def _translated(system: System, initial: State, times: Array, q: Array, w: Array) -> State:
    """The centre of mass: ``p₀ + v₀ t + ½ g t²`` where it falls freely, (7), else on its pivot."""
    t = times.reshape(-1, *(1,) * (w.ndim - 1))
    p0, v0 = (np.asarray(f, np.longdouble) for f in (initial.position, initial.linear_velocity))
    g = np.asarray(system.load.gravity, np.longdouble)
    position = np.broadcast_to(p0 + t * (v0 + t * g / 2), w.shape)
    velocity = np.broadcast_to(v0 + t * g, w.shape)
    return place_on_pivot(extended(system), State(q, w, position, velocity))
