"""Between samples: the cubic that has the values and the slopes at both ends, and its zeros."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.reference_impl.system import Array

# Newton's method doubles the digits each time; bisection catches what leaves its bracket.
ITERATIONS = 8


@dataclass(frozen=True)
class Hermite:
    """A curve through samples. times: (n,) s, increasing.  values, slopes: (n, k)."""

    times: Array
    values: Array
    slopes: Array

    def at(self, times: Array) -> tuple[Array, Array]:
        """(m, k) values and slopes at `times` (m,) s, within the first and the last sample."""
        left = np.clip(np.searchsorted(self.times, times, "right") - 1, 0, len(self.times) - 2)
        h = (self.times[left + 1] - self.times[left])[:, None]
        ends = (self.values[left], self.values[left + 1])
        rises = (h * self.slopes[left], h * self.slopes[left + 1])
        value, rise = _cubic((times - self.times[left])[:, None] / h, *ends, *rises)
        return value, rise / h


def _cubic(
    s: Array, start: Array, end: Array, start_rise: Array, end_rise: Array
) -> tuple[Array, Array]:
    """The value at ``s = (t - t0) / h`` and its derivative in s. The rises are those of the ends.

    It is ``v0 + s (d + (1 - s) ((1 - s) a + s b))``, ``d = v1 - v0``, ``a = h v0' - d``,
    ``b = d - h v1'``.
    """
    d, r = end - start, 1.0 - s
    a, b = start_rise - d, d - end_rise
    value = start + s * (d + r * (r * a + s * b))
    return value, d + r * (r - 2.0 * s) * a + s * (2.0 * r - s) * b


def error_factor(share: float) -> float:
    """The cubic's error over ``h^4 max |v''''|``: ``s^2 (1 - s)^2 / 24`` at the share s of a gap.

    Hildebrand, Introduction to Numerical Analysis, section 8.2.
    """
    return (share * (1.0 - share)) ** 2 / 24.0


def _signs(values: Array) -> Array:
    """Signs, a zero taking that of the last sample before it that has one: touching is no change.

    Zeros at the start take the first one's.
    """
    signs = np.sign(values)
    known = np.where(signs != 0.0, np.arange(len(signs)), 0)
    filled: Array = signs[np.maximum.accumulate(known)]
    return np.where(filled != 0.0, filled, signs[np.argmax(signs != 0.0)])


def zero_crossings(times: Array, values: Array, slopes: Array) -> Array:
    """(m,) s: where the cubic through samples (n,) of one quantity changes its sign."""
    positive = _signs(values) > 0.0
    left = np.flatnonzero(positive[1:] != positive[:-1])
    if not len(left):
        return np.empty(0)
    h = times[left + 1] - times[left]
    start, end = values[left], values[left + 1]
    low, high, s = np.zeros(len(left)), np.ones(len(left)), -start / (end - start)
    for _ in range(ITERATIONS):
        value, slope = _cubic(s, start, end, h * slopes[left], h * slopes[left + 1])
        before = (value > 0.0) == (start > 0.0)
        low, high = np.where(before, s, low), np.where(before, high, s)
        with np.errstate(divide="ignore", invalid="ignore"):
            newton = s - value / slope
        inside = (newton >= low) & (newton <= high)
        s = np.where(inside, newton, 0.5 * (low + high))
    crossings: Array = times[left] + s * h
    return crossings
