"""What random systems have in them, drawn from a seed: the same seed gives the same traits.

They come in blocks of 24. Within a block every two traits occur together, and magnitudes are spread
evenly over their range.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.random import Generator

from omegadot.scenarios.pairs import covering_rows

BLOCK = 24
TRAITS = {
    "support": ("free", "flying", "pivot", "pivot-at-origin"),
    "center": ("offset", "origin"),
    "gravity": ("none", "down", "axis", "oblique"),
    "damping": ("none", "weak", "strong"),
    "torque": ("none", "body", "world"),
    "inertia": ("diagonal", "full", "near-equal", "thin"),
    "bulk": ("light-small", "light-large", "heavy-small", "heavy-large"),
    "rate": ("slow", "middle", "fast"),
    "scalar": ("positive", "negative", "zero"),
    "steps": ("coarse", "medium", "long"),
    "end": ("whole", "short"),
}
# Signs of the components of a torque; two neighbours have both signs of each.
OCTANTS = (0b000, 0b111, 0b001, 0b110, 0b010, 0b101, 0b011, 0b100)
SPREAD_BY = {
    **{"mass": "bulk", "size": "bulk", "rate": "rate", "speed": "support"},
    **{"damping": "damping", "gravity": "gravity", "inertia": "inertia"},
}


@dataclass(frozen=True)
class Draw:
    """What is drawn of a system before its numbers.

    share: of the range of each magnitude.  octant: of a torque, a bit for each component's sign.
    """

    traits: Mapping[str, str]
    share: Mapping[str, float]
    octant: int


def _ranks(groups: Sequence[object], random: Generator) -> list[tuple[int, int]]:
    """For every row its number within its group, in random order, and how many these are."""
    places = defaultdict(list)
    for row, group in enumerate(groups):
        places[group].append(row)
    found = [(0, 1)] * len(groups)
    for rows in places.values():
        for rank, row in enumerate(random.permutation(rows)):
            found[row] = (rank, len(rows))
    return found


@lru_cache(64)
def _block(seed: int, number: int) -> tuple[Draw, ...]:
    random = np.random.default_rng([seed, number, BLOCK])
    rows = covering_rows(TRAITS, BLOCK, random)
    shares = [dict[str, float]() for _ in rows]
    for name, by in SPREAD_BY.items():
        for share, (rank, of) in zip(shares, _ranks([r[by] for r in rows], random), strict=True):
            share[name] = (rank + random.random()) / of
    # those of large torques have every sign among them, and so have the others
    ranks = _ranks([_drive(row) for row in rows], random)
    octants = [OCTANTS[rank % len(OCTANTS)] for rank, _ in ranks]
    return tuple(map(Draw, rows, shares, octants))


def _drive(traits: Mapping[str, str]) -> tuple[bool, bool]:
    """Whether a torque acts, and whether it is large."""
    large = traits["bulk"].endswith("large") and traits["rate"] != "slow"
    return traits["torque"] != "none", large


def drawn(seed: int, index: int) -> Draw:
    """The traits of the system of this number."""
    number, row = divmod(index, BLOCK)
    return _block(seed, number)[row]
