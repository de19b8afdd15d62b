"""What every formula has: one factor, that is fitted, and what its symbols are."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence

import numpy as np

from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.formula.facts import MATRICES, SIZES, VECTORS
from omegadot.diagnosis.equations.formula.law import symbols_of
from omegadot.diagnosis.equations.formula.rows import Rows, factors
from omegadot.reference_impl.motion import center_of_mass_acceleration
from omegadot.reference_impl.system import Acceleration, Array


class Factored(ABC):
    """One thing that is added to the right equation, times one factor."""

    @abstractmethod
    def rows(self, every: Sequence[Evidence]) -> Rows:
        """What it must make at the states of these."""

    @abstractmethod
    def line(self, rows: Rows) -> Array:
        """What a factor of one adds there, (n, 3) in body axes."""

    @abstractmethod
    def made(self, evidence: Evidence, p: Array) -> Acceleration:
        """The accelerations with this factor."""

    @abstractmethod
    def slack(self, evidence: Evidence, p: Array) -> Array:
        """(n,): in bounds, how far these may be from an engine's."""

    @property
    def ones(self) -> Array:
        """A factor of one."""
        return np.ones(1)

    def factor(self, every: Sequence[Evidence]) -> Array:
        """The factor that fits these best, (1,)."""
        rows = self.rows(every)
        return np.array([factors(self.line(rows), rows)])

    def fit(self, evidence: Evidence) -> Array | None:
        """The factor with which this is the engine's equation; None where none is."""
        k = self.factor([evidence])
        if not np.isfinite(k[0]) or not k[0]:
            return None
        return k if evidence.fits(self.made(evidence, k), self.slack(evidence, k)) else None


def with_angular(evidence: Evidence, angular: Array) -> Acceleration:
    """The right accelerations with another omega-dot, which a pivoted body's place follows."""
    if evidence.system.load.pivot is None:
        return Acceleration(angular, evidence.true.linear)
    linear = center_of_mass_acceleration(evidence.system, evidence.states, angular)
    return Acceleration(angular, linear)


def legend_of(texts: Sequence[str]) -> list[str]:
    """What the symbols in formulas are, of those that need a definition."""
    used, known = symbols_of(texts), {**VECTORS, **MATRICES, **SIZES}
    return [f"{k} {known[k][1]}" for k in known if k in used and known[k][1]]
