"""Wrong equations that are the right one and a few terms more."""

from __future__ import annotations

from collections.abc import Sequence

from omegadot.diagnosis.equations.terms.angular import ANGULAR
from omegadot.diagnosis.equations.terms.mixed import MIXED
from omegadot.diagnosis.equations.terms.terms import Terms
from omegadot.diagnosis.equations.terms.translation import LINEAR, REPORTED

__all__ = ["FEW", "MORE", "MOST", "Terms"]
FEW: Sequence[Terms] = (*REPORTED, *ANGULAR[:4], *LINEAR[:1])
MORE: Sequence[Terms] = (*ANGULAR[4:], *LINEAR[1:])
MOST: Sequence[Terms] = MIXED
