"""The best fit of the motion on a trace, over a horizon that grows.

Over a long trace the error of a start's rates turns phases round, and the sum of squares has many
minima. Over a short one it has one. So the first few radians are fitted first, then more.
"""

from __future__ import annotations

import numpy as np

from omegadot.commands.fit.data import Data
from omegadot.commands.fit.parameters import Free, Parameters
from omegadot.commands.fit.solve import Fitted, cost_of, solve

FIRST_TURN = 3.0  # rad, of the first horizon
GROWTH = 2.5  # of a horizon to the next
LEAST_SAMPLES = 8  # of a horizon
TRIED = 4  # of the starts, over the first horizon
FOLLOWED = 2  # of the fits over the first horizon
SAME = 1e-2  # costs of one minimum differ by less


def follow(data: Data, starts: list[Parameters], free: Free) -> Fitted:
    """The least squares over horizons that grow to the whole, from the best of the starts.

    The nearest are fitted over the first horizon, and the best of these over the whole.
    """
    counts = _horizons(data)
    short = data.until(counts[0])
    near = sorted(starts, key=lambda one: cost_of(short, one, free))[:TRIED]
    found = sorted((solve(short, one, free) for one in near), key=lambda fit: fit.cost)
    ends = []
    for fit in _different(found)[:FOLLOWED]:
        for count in counts[1:]:
            fit = solve(data.until(count), fit.one, free)
        ends.append(fit)
    return min(ends, key=lambda fit: fit.cost)


def _horizons(data: Data) -> list[int]:
    """How many samples each horizon has, the whole last."""
    turned, whole = data.turned, len(data.times)
    counts, reach = [], FIRST_TURN
    while reach < turned[-1] / np.sqrt(GROWTH):
        count = max(int(np.searchsorted(turned, reach)), LEAST_SAMPLES)
        if count < whole and count not in counts:
            counts.append(count)
        reach *= GROWTH
    return [*counts, whole]


def _different(fits: list[Fitted]) -> list[Fitted]:
    """Those in rising order that are not one minimum again."""
    kept: list[Fitted] = []
    for fit in fits:
        if not any(abs(fit.cost - other.cost) <= SAME * fit.cost for other in kept):
            kept.append(fit)
    return kept
