"""A figure that was measured round after round: its median, its quartiles, and the rounds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Spread:
    """rounds: the values, one a round; in each round everything was measured in turn."""

    rounds: tuple[float, ...]

    @property
    def median(self) -> float:
        """The middle value."""
        return self._quantile(0.5)

    @property
    def quartiles(self) -> tuple[float, float]:
        """A quarter of the values lies below the first, a quarter above the second."""
        return self._quantile(0.25), self._quantile(0.75)

    def _quantile(self, share: float) -> float:
        return float(np.quantile(np.asarray(self.rounds), share))

    def scaled(self, factor: float) -> Spread:
        """Every value multiplied."""
        return Spread(tuple(value * factor for value in self.rounds))

    def under(self, numerator: float) -> Spread:
        """The numerator over every value."""
        return Spread(tuple(numerator / value for value in self.rounds))

    def over(self, other: Spread) -> Spread:
        """Round by round, this over the other: what slowed a whole round cancels."""
        return Spread(tuple(a / b for a, b in zip(self.rounds, other.rounds, strict=True)))


def total(spreads: Sequence[Spread]) -> Spread:
    """The sum, round by round."""
    return Spread(tuple(map(sum, zip(*(spread.rounds for spread in spreads), strict=True))))
