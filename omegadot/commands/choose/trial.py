"""One run that was made while a step was sought, and how it stands to the requirements."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from omegadot.commands.choose.requirements import ACCURACY

Row = dict[str, Any]


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
    the truth.  accuracy: of an error-controlled integrator. Its steps are a nominal number, see
    `Candidate.accuracy_of`.
    """

    steps: int
    timestep: float
    errors: Mapping[str, Measured]
    seconds_per_step: float
    samples: int
    accuracy: float | None = None

    @property
    def knobs(self) -> Row:
        """The step or the accuracy, and the number of steps."""
        timestep = self.timestep if self.accuracy is None else None
        return {"timestep": timestep, "accuracy": self.accuracy, "steps": self.steps}

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

    def row(self, limits: Mapping[str, float]) -> Row:
        """Its step, its errors and by how much each limit exceeds them."""
        errors = {
            key: {**vars(found), "margin": limits[key] / found.most if found.most > 0.0 else None}
            for key, found in self.errors.items()
        }
        judged = {"ratio": self.ratio(limits), "passes": self.passes(limits)}
        return {**vars(self), **self.knobs, "errors": errors, **judged}

    def missed_rows(self, limits: Mapping[str, float]) -> list[Row]:
        """The limits that it misses, the worst first, and by what factor."""
        return [
            {"requirement": key, "limit": limits[key], "unit": ACCURACY[key][1]}
            | {"found": self.errors[key].most if self.errors else None}
            | {"factor": self.errors[key].most / limits[key] if self.errors else None}
            | self.knobs
            for key in self.missed(limits)
        ]
