"""What may be mistyped in one place, and what each of its terms adds to an acceleration."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.mistyped.few import Few
from omegadot.diagnosis.equations.readings import Reading
from omegadot.reference_impl.system import Array

ANGULAR, LINEAR = "angular", "linear"  # of what the terms are


@dataclass(frozen=True)
class Kind:
    """Terms (k, n, 3) of one formula at states (n,), and the causes of a few with their factors.

    of: omega-dot or the linear acceleration, both in body axes.  without: a component that other
    places change as well, and that is not looked at.  any_factors: all terms at once, not a few by
    the factors that a slip of the hand has.
    """

    of: str
    lines: Callable[[Evidence], Array]
    readings: Callable[[Few], Iterator[Reading]]
    without: int | None = None
    any_factors: bool = False
