"""One run that was made while a step was sought, and how it stands to the requirements."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Measured:
    """The greatest error over the horizon, and how far the truth leaves it open, in SI units."""

    value: float
    open: float

    @property
    def most(self) -> float:
        """What the error may be at most."""
        return self.value + self.open


@dataclass(frozen=True)
class Trial:
    """A run over the whole horizon in `steps` steps of `timestep` s.

    errors: by requirement; none where the run failed.  samples: how many states were held against
    the truth.
    """

    steps: int
    timestep: float
    errors: Mapping[str, Measured]
    seconds_per_step: float
    samples: int

    def ratio(self, limits: Mapping[str, float]) -> float:
        """The greatest error over its limit; 1 or less meets them all."""
        if not self.errors:
            return math.inf
        found = [self.errors[key].most / limit for key, limit in limits.items()]
        return max((r if math.isfinite(r) else math.inf) for r in found)

    def passes(self, limits: Mapping[str, float]) -> bool:
        """Whether every limit is met, to the resolution of the truth."""
        return self.ratio(limits) <= 1.0

    def missed(self, limits: Mapping[str, float]) -> list[str]:
        """The requirements that are not met, the worst first."""
        if not self.errors:
            return list(limits)
        far = {k: self.errors[k].most / limit for k, limit in limits.items()}
        over = [key for key, ratio in far.items() if not ratio <= 1.0]
        return sorted(over, key=lambda k: -far[k] if math.isfinite(far[k]) else -math.inf)
