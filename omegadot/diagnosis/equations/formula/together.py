"""Two formulas at once: one of omega-dot, and one of a free body's linear acceleration."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.formula.search import AnyFormula
from omegadot.reference_impl.system import Acceleration, Array, System


@dataclass(frozen=True)
class Together:
    """Their factors are two numbers, (2,)."""

    angular: AnyFormula
    linear: AnyFormula

    @property
    def ones(self) -> Array:
        """Both with a factor of one."""
        return np.ones(2)

    @property
    def cost(self) -> float:
        """How far from plain they are."""
        return self.angular.cost + self.linear.cost

    @property
    def name(self) -> str:
        """What they are, whatever the factors."""
        return f"{self.angular.name} and {self.linear.name}"

    def made(self, evidence: Evidence, p: Array) -> Acceleration:
        """The accelerations of both."""
        turned = self.angular.made(evidence, p[:1])
        if evidence.system.load.pivot is not None:
            return turned
        return replace(turned, linear=self.linear.made(evidence, p[1:]).linear)

    def slack(self, evidence: Evidence, p: Array) -> Array:
        """(n,): in bounds."""
        more = self.linear.slack(evidence, p[1:])
        return np.maximum(self.angular.slack(evidence, p[:1]), more)

    def factor(self, every: Sequence[Evidence]) -> Array:
        """The factors that fit these best, (2,)."""
        free = [e for e in every if e.system.load.pivot is None] or every
        return np.concatenate([self.angular.factor(every), self.linear.factor(free)])

    def fit(self, evidence: Evidence) -> Array | None:
        """The factors with which this is the engine's equation; None where none are."""
        p = self.factor([evidence])
        good = bool(np.all(np.isfinite(p)))
        return (
            p if good and evidence.fits(self.made(evidence, p), self.slack(evidence, p)) else None
        )

    def text(self, system: System, p: Array) -> str:
        """The cause, with its factors."""
        return f"{self.angular.text(system, p[:1])}; and {self.linear.text(system, p[1:])}"
