"""Right but late, or wrong: the time shift that fits omega best, what is left, and the flips."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from omegadot.gates.bounds.scales import EPS, norm
from omegadot.gates.errors.measured_run import MeasuredRun
from omegadot.gates.rows import Row
from omegadot.gates.runs.interpolation import Hermite, error_factor, zero_crossings
from omegadot.gates.truth import Truth
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.system import Array, State, System
from omegadot.written import written

GATE = "trajectory"
# A shift is sought up to this part of the run, so that enough samples stay to be compared.
FARTHEST = 0.25
MOST_ITERATIONS = 12


@dataclass(frozen=True)
class Shift:
    """omega(t) is nearest to the exact omega(t + shift); residual: (m,) rad/s, what is left."""

    shift: float
    residual: Array


def _mean_squares(exact: Array, omega: Array, farthest: int) -> tuple[NDArray[np.intp], Array]:
    """Lags in samples, and the mean square of ``omega[i] - exact[i + lag]`` where both exist."""
    n = len(omega)
    lags = np.arange(-farthest, farthest + 1)
    products = sum(
        np.correlate(exact[:, k], omega[:, k], "full")[n - 1 - farthest : n + farthest]
        for k in range(3)
    )
    own = np.concatenate([[0.0], np.cumsum(np.sum(omega * omega, axis=-1))])
    other = np.concatenate([[0.0], np.cumsum(np.sum(exact * exact, axis=-1))])
    first, last = np.maximum(0, -lags), n - np.maximum(0, lags)
    size = own[last] - own[first] + other[last + lags] - other[first + lags]
    return lags, (size - 2.0 * products) / (last - first)


def _start(exact: Hermite, omega: Array) -> float:
    """A shift in s to begin with: the smallest in whole samples that fits as well as any.

    In a periodic motion a period more fits as well, and half a sample of shift is allowed for.
    """
    gap = float(exact.times[1] - exact.times[0])
    n = len(exact.times)
    even = n if n < 3 or exact.times[-1] - exact.times[-2] > 0.5 * gap else n - 1
    farthest = int(FARTHEST * even)
    lags, squares = _mean_squares(exact.values[:even], omega[:even], farthest)
    allowed = 0.25 * gap**2 * float(np.mean(np.sum(exact.slopes**2, axis=-1)))
    fitting = lags[squares <= max(float(np.min(squares)), 0.0) + allowed]
    return gap * float(fitting[np.argmin(np.abs(fitting))]) if len(fitting) else 0.0


def best_shift(exact: Hermite, omega: Array) -> Shift:
    """The shift that minimises the sum of ``|omega(t) - exact(t + shift)|^2``, by Gauss-Newton.

    omega: (n, 3) rad/s at the times of `exact`.
    """
    times, shift = exact.times, _start(exact, omega)
    gap, farthest = float(times[1] - times[0]), FARTHEST * float(times[-1])
    for _ in range(MOST_ITERATIONS):
        inside = (times + shift >= 0.0) & (times + shift <= times[-1])
        value, slope = exact.at(times[inside] + shift)
        residual = omega[inside] - value
        change = float(np.sum(residual * slope) / np.sum(slope * slope))
        change = float(np.clip(change, -gap, gap))
        if not abs(shift + change) <= farthest or abs(change) <= EPS * float(times[-1]):
            break
        shift += change
    return Shift(shift, norm(residual))


def _bend(exact: Hermite) -> float:
    """rad/s: the gap to the fourth times omega's fourth derivative, by differences of omega-dot.

    The third difference is an average over three gaps; the fourth states how far it may be
    exceeded.
    """
    gap = float(exact.times[1] - exact.times[0])
    third = np.diff(exact.slopes[:-1], 3, axis=0)  # the last gap may be a shorter one
    return gap * float(np.max(norm(third)) + np.max(norm(np.diff(third, axis=0)), initial=0.0))


def middle_axis(system: System) -> Array | None:
    """(3,) unit vector of the middle moment of inertia; None where two moments are equal."""
    moments, axes = np.linalg.eigh(np.asarray(moving_inertia(system), dtype=float))
    if np.min(np.diff(moments)) <= 64 * EPS * moments[-1]:
        return None
    axis: Array = axes[:, 1]
    return axis


def flip_rows(system: System, exact: Hermite, state: State, floor: float, gap: float) -> list[Row]:
    """The largest error among the flips: the zeros of omega along the middle axis, in order.

    floor: rad/s, what rounding and interpolation leave open.  gap: rad/s, an omega along that axis
    below it does not flip, it is rounding.
    """
    axis = middle_axis(system)
    if axis is None:
        return []
    along = exact.values @ axis
    if not np.max(np.abs(along)) > gap:
        return []
    rate = exact.slopes @ axis
    flips = zero_crossings(exact.times, along, rate)
    if not len(flips):
        return []
    own = state.angular_velocity @ axis
    own_rate = forward_dynamics(system, state).angular @ axis
    found = zero_crossings(exact.times, own, own_rate)
    count = min(len(flips), len(found))
    error = float(np.max(np.abs(found[:count] - flips[:count]))) if count else float("inf")
    steepness = np.abs(exact.at(flips)[1] @ axis)
    with np.errstate(divide="ignore"):
        open_time = float(np.max(floor / steepness))
    note = f"flips: {len(found)}, in the exact motion: {len(flips)}"
    return [Row(GATE, "time", "flip_time_error", error, "s", open_time, note=note)]


def rows(truth: Truth, measured: MeasuredRun, state: State) -> list[Row]:
    """Time shift, what is left after it, and the flips' error; none where omega is constant.

    Nothing is judged. The bounds are no limits: they state what rounding and the cubic between the
    exact samples leave open.
    """
    place = truth.rows(measured.sweep)
    times, omega_dot = truth.times[place], truth.omega_dot[place]
    exact = Hermite(times, truth.state.angular_velocity[place], omega_dot)
    rate, bounds = truth.yardstick.rate, measured.round_off["omega"]
    rounding = rate * float(np.max(bounds[np.isfinite(bounds)], initial=truth.yardstick.eps))
    change = float(np.sqrt(np.mean(np.sum(omega_dot**2, axis=-1))))
    if len(times) < 5 or not change * float(times[-1]) > rounding:
        return []
    with np.errstate(all="ignore"):
        best = best_shift(exact, state.angular_velocity)
        left = float(np.max(best.residual)) / rate
        if not np.isfinite(left):
            return []
        gap = float(times[1] - times[0])
        bend = _bend(exact)
        floor = rounding + bend * error_factor(abs(best.shift) / gap % 1.0)
        before = float(np.max(measured.error["omega"]))
        text = f"{written(before, 2)} without the shift"
        when = f"{'late' if best.shift < 0.0 else 'early'} by {written(abs(best.shift), 3)} s"
        between = rounding + bend * error_factor(0.5)
        flips = flip_rows(truth.yardstick.system, exact, state, between, rounding)
    return [
        Row(GATE, "time", "time_shift", best.shift, "s", floor / change, note=when),
        Row(GATE, "omega", "residual_after_shift", left, "1", floor / rate, note=text),
        *flips,
    ]
