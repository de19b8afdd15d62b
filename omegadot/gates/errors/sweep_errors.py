"""The errors of one channel in one run of a sweep over steps."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from omegadot.reference_impl.system import Array

Point = tuple[float, float, float, bool]
"""Step, error, bound of rounding, and whether errors saturate."""

# Beyond half a radian, or half its size, an error is no longer a power of the step: it saturates.
SATURATED = 0.5
# Rounding is then a tenth of the error at most, and its bound is seldom reached.
CLEAR_OF_ROUNDING = 10.0
HORIZONS = tuple(0.5**n for n in range(7))  # of a run's samples
FEWEST_STEPS = 3  # two slopes, which must agree
FEWEST_SAMPLES = 5  # an error may be nothing at one sample, as its sign changes there
# From one sample to the next, what stepping adds may be this many times all that it added before.
LARGEST_RISE = 100.0


@dataclass(frozen=True)
class Errors:
    """One channel of one run: the step, and (n,) each: times, errors, and bounds of rounding.

    overall: (n,), the largest error of omega, attitude and velocity, which saturate where they are
    as large as the motion.  saturates: whether this is one of them.  signed: (n,), the errors with
    their signs, of a channel that is one number.
    """

    timestep: float
    times: Array
    size: Array
    bound: Array
    overall: Array
    saturates: bool
    signed: Array | None = None

    def largest(self, horizon: float) -> tuple[float, float, bool]:
        """Error and bound over a part of the samples, and whether errors saturate there."""
        last = int(np.ceil(horizon * len(self.size))) - 1
        error, bound, overall = self.until[:, last]
        return float(error), float(bound), not overall <= SATURATED

    @cached_property
    def until(self) -> Array:
        """(3, n): the largest error, bound and overall error up to each sample."""
        found: Array = np.maximum.accumulate((self.size, self.bound, self.overall), axis=-1)
        return found

    @property
    def shows(self) -> bool:
        """Whether it is clear of rounding over the whole run or a first part of it."""
        parts = map(self.largest, HORIZONS)
        return any(error > CLEAR_OF_ROUNDING * bound for error, bound, _ in parts)

    @property
    def saturates_at(self) -> int:
        """The first sample whose error saturates; the number of samples if none does."""
        beyond = ~(self.overall <= SATURATED)
        return int(np.argmax(beyond)) if beyond.any() else len(beyond)
