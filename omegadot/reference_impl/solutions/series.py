"""The exact motion by its Taylor series: the truth where no closed form exists.

The equations are quadratic, so each coefficient of the solution follows from the earlier ones by
one convolution. Everything runs in the extended type of ``precision.py``, and to 2^-63 a step
whichever that is: what is left of rounding and of the cut series is far below a double's, and the
steps are the same on every platform.

Method: Jorba and Zou, A software package for the numerical integration of ODEs by means of
high-order Taylor methods, Experimental Mathematics 14 (2005) 99-117.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from omegadot.reference_impl.arithmetic.precision import (
    LEAST_EPS,
    extended,
    in_doubles,
    to_double,
    to_extended,
)
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.solutions.representable import UnrepresentableError
from omegadot.reference_impl.solutions.series_equations import Equations, G, Q, T, W, equations_of
from omegadot.reference_impl.system import Array, State, System
from omegadot.written import written

# Optimal is about -ln(eps)/2, 22 for 2^-63; a little more costs little and gives longer steps,
# which dense output over few samples likes.
ORDER = int(-0.6 * np.log(LEAST_EPS)) + 2
MOST_STEPS = 100_000  # minutes of work


@dataclass(frozen=True)
class Segment:
    """One step: x(start + s) = Σ_k coefficients[..., k] s^k for s between 0 and `length`.

    start: extended.  length: any double that is short enough.
    """

    start: Array
    length: float
    coefficients: Array

    @property
    def end(self) -> Array:
        """Where the next step starts, extended."""
        return self.start + self.length

    def at(self, times: Array) -> Array:
        """The x at times (n,), (n, lanes, 13), by Horner's rule."""
        s = (times - self.start)[:, None, None]
        value = s * 0.0 + self.coefficients[..., ORDER]
        for k in range(ORDER - 1, -1, -1):
            value = value * s + self.coefficients[..., k]
        return value


def taylor_coefficients(equations: Equations, x: Array) -> Array:
    """Coefficients 0 to ORDER of the solution through x: (lanes, 13) to (lanes, 13, ORDER + 1).

    ``(k + 1) x_{k+1} = Σ_{j<=k} quadratic(x_j, ω_{k-j}) + linear(x_k) + constant [k = 0]``.
    """
    lanes = len(x)
    series = to_extended(np.zeros((lanes, 13, ORDER + 1)))
    backwards = to_extended(np.zeros((lanes, ORDER + 1, 3)))  # ω_k stands at ORDER - k
    table = equations.table
    series[..., 0] = x
    for k in range(ORDER):
        backwards[:, ORDER - k] = series[:, W, k]
        products = series[..., : k + 1] @ backwards[:, ORDER - k :]
        rate = np.concatenate((products.reshape(lanes, 39), series[..., k]), -1) @ table
        if k == 0:
            rate = rate + equations.constant
        series[..., k + 1] = rate / (k + 1)
    return series


def _step_length(series: Array) -> float:
    """The step at which the last two terms are as small as rounding, the least over the lanes.

    Each of q, ω, g and t is measured by its own size; ω by ``max(|ω|, |ω̇|^½)``, which has a size
    at rest too. Infinite where the last terms vanish: the solution is a polynomial.
    """
    longest, sizes = float("inf"), np.abs(to_double(series))
    for part in (Q, W, G, T):
        size = np.max(sizes[:, part], 1)  # (lanes, ORDER + 1)
        scale = size[:, 0]
        if part is W:
            scale = np.maximum(scale, np.sqrt(size[:, 1]))
        for k in (ORDER - 1, ORDER):
            moving = size[:, k] > 0
            if np.any(moving):
                ratio = LEAST_EPS * scale[moving] / size[moving, k]
                longest = min(longest, float(np.min(ratio)) ** (1 / k))
    return longest


def _segments(equations: Equations, x: Array, end: float) -> Iterator[Segment]:
    """Steps from time zero to `end`, which may be negative."""
    start, sign = to_extended(0.0), float(np.sign(end))
    while True:
        series = taylor_coefficients(equations, x)
        length = _step_length(series)
        passed = abs(float(to_double(start)))
        if length >= abs(end) - passed:
            yield Segment(start, end - sign * passed, series)
            return
        if not length > LEAST_EPS * passed:
            raise UnrepresentableError("the motion leaves the range of numbers")
        if (abs(end) - passed) / length > MOST_STEPS:
            count = written((abs(end) - passed) / length, 2)
            raise UnrepresentableError(
                f"the motion is so fast that its series would take {count} steps"
            )
        segment = Segment(start, sign * length, series)
        yield segment
        x = equations.refreshed(segment.at(segment.end[None])[0])
        start = segment.end


def _fill(
    equations: Equations, x0: Array, times: Array, which: NDArray[np.intp], found: Array
) -> None:
    """Put x at ``times[which]``, all of one sign and sorted outwards from zero, into `found`."""
    if not len(which):
        return
    ahead = np.abs(times[which])
    first = 0
    for segment in _segments(equations, x0, float(times[which[-1]])):
        last = first + np.searchsorted(ahead[first:], abs(to_double(segment.end)), "right")
        inside = which[first:last]
        if len(inside):
            found[inside] = segment.at(times[inside])
        first = int(last)
    found[which[first:]] = segment.at(times[which[first:]])


def solve_series(system: System, initial: State, times: Array) -> State:
    """The state at `times`, (n,) s in any order and of either sign; `initial` holds at zero.

    Leading axes of `initial` are lanes, which share their steps: the result has (n, lanes, ...).
    Raises ValueError for a system with leading axes or a state or time that is not finite, and
    UnrepresentableError for a motion that no series can follow to its end.
    """
    return in_doubles(solve_extended(system, initial, times))


def solve_extended(system: System, initial: State, times: Array) -> State:
    """As `solve_series`, with all digits of the extended type."""
    seconds = np.asarray(times, float)
    fields = (initial.orientation, initial.angular_velocity, seconds)
    if seconds.ndim != 1 or not all(np.all(np.isfinite(field)) for field in fields):
        raise ValueError("the times are to be a list, and they and the state finite")
    equations = equations_of(system)
    equations = equations.in_own_time(equations.unknown(initial))
    x0, moments = equations.unknown(initial), seconds / equations.unit
    lanes, flat = x0.shape[:-1], x0.reshape(-1, 13)
    found = to_extended(np.zeros((len(moments), *flat.shape)))
    order = np.argsort(moments, kind="stable")
    split = int(np.searchsorted(moments[order], 0))
    _fill(equations, flat, moments, order[split:], found)
    _fill(equations, flat, moments, order[:split][::-1], found)
    x = found.reshape(len(moments), *lanes, 13)
    return _translated(
        system, initial, seconds, normalize(x[..., Q]), equations.angular_velocity(x)
    )


def _translated(system: System, initial: State, times: Array, q: Array, w: Array) -> State:
    """The centre of mass: ``p₀ + v₀ t + ½ g t²`` where it falls freely, (7), else on its pivot."""
    t = to_extended(times.reshape(-1, *(1,) * (w.ndim - 1)))
    p0, v0 = to_extended(initial.position), to_extended(initial.linear_velocity)
    g = to_extended(system.load.gravity)
    position = np.broadcast_to(p0 + t * (v0 + t * g / 2), w.shape)
    velocity = np.broadcast_to(v0 + t * g, w.shape)
    return place_on_pivot(extended(system), State(q, w, position, velocity))
