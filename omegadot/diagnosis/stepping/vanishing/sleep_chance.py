"""Whether chance makes a law of sleep: how many times as many laws would have to be tried.

Of n scenarios k fall asleep. Chance alone gives these the k smallest of any quantity in one of
``C(n, k)`` ways. It lets a run fall asleep in any of its F steps, of which a law whose limit is
known between two numbers allows m: one of the runs gives the limit, and each scenario besides is
a chance of ``m / F``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import comb, prod

from omegadot.diagnosis.stepping.vanishing.spells import Spell


@dataclass(frozen=True)
class Law:
    """The place of its quantity in `UNITS`, and between which numbers its limit is.

    count: steps in a row; or s, for a time.  way: 1 where the given state is counted as well.
    """

    quantity: int
    low: float
    high: float
    way: int
    count: int = 0
    time: float = 0.0


def odds_against(law: Law, spells: Sequence[Spell], apart: int) -> float:
    """How many laws chance would have to be given for one like this.

    spells: of the runs that fall asleep.  apart: scenarios that do not.
    """
    shares = dict[str, float]()
    for one in spells:
        count = law.count or one.steps_of(law.time)
        among = one.steps_between(law.quantity, count, law.way, law.low, law.high) + one.early
        share = min(1.0, max(1, among) / one.fell)
        shares[one.name] = min(share, shares.get(one.name, 1.0))
    rarest = min(shares.values())
    ways = comb(len(shares) + apart, apart)
    return ways * rarest / prod(shares.values())
