"""What random systems have in them, drawn from a seed: the same seed gives the same traits.

They come in blocks of 24. Within a block every two traits occur together, and magnitudes are spread
evenly over their range. Two systems of a block spin steadily, at steps that turn them far. Some of
those with a torque in body or in world axes have another in the other axes.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from operator import itemgetter

import numpy as np
from numpy.random import Generator

from omegadot.scenarios.pairs import covering_rows

BLOCK = 24
FOURTH = 4  # of the systems with a torque in one frame, those with another in the other
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
# A body that turns at a constant omega: every scheme's error is then that of its turns alone.
STEADY = {
    **{"support": "free", "damping": "none", "torque": "none", "inertia": "diagonal"},
    **{"steps": "coarse", "end": "whole"},
}
STEADY_INERTIAS = (0.0, 0.5)  # shares of the range: a sphere, and a body of three moments


def _weight_and_support(traits: Mapping[str, str]) -> object:
    """A pivoted body's mass shows in its turning, a free one's does not."""
    return traits["bulk"].partition("-")[0], traits["support"].startswith("pivot")


def _weighs(traits: Mapping[str, str]) -> int:
    """Whether there is gravity."""
    return int(traits["gravity"] != "none")


def _far(traits: Mapping[str, str]) -> int:
    """How far it may be, by its size; of those alike, those under gravity."""
    return 2 * traits["bulk"].endswith("large") + _weighs(traits)


def _flies(traits: Mapping[str, str]) -> int:
    """How fast it may fly, by its size and rate; of those alike, those under gravity."""
    fast = {"slow": 0, "middle": 3, "fast": 5}[traits["rate"]]
    return 2 * (fast + 3 * traits["bulk"].endswith("large")) + _weighs(traits)


def _acts(traits: Mapping[str, str]) -> int:
    """How much a mass or a size shows: in a weight that turns the body above all, or by a lever."""
    support = traits["support"]
    has_lever = support == "pivot" or (support, traits["center"]) == ("pivot-at-origin", "offset")
    others = sum(traits[load] != "none" for load in ("torque", "damping"))
    return (1 + _weighs(traits)) * (4 if has_lever else 1) + others


SPREAD_BY: dict[str, Callable[[Mapping[str, str]], object]] = {
    "mass": _weight_and_support,
    "size": itemgetter("bulk"),
    "rate": itemgetter("rate"),
    "speed": itemgetter("support"),
    "place": itemgetter("support"),
    "damping": itemgetter("damping"),
    "gravity": itemgetter("gravity"),
    "inertia": itemgetter("inertia"),
}


SHOWN_BY: dict[str, Callable[[Mapping[str, str]], int]] = {
    **{"mass": _acts, "size": _acts, "speed": _flies, "place": _far}
}


@dataclass(frozen=True)
class Draw:
    """What is drawn of a system before its numbers.

    share: of the range of each magnitude.  octant: of a torque, a bit for each component's sign.
    steady: its omega is constant.  both: a torque acts in the other frame as well.
    """

    traits: Mapping[str, str]
    share: Mapping[str, float]
    octant: int
    steady: bool = False
    both: bool = False


def _ranks(
    groups: Sequence[object], random: Generator, shows: Sequence[int] = ()
) -> list[tuple[int, int]]:
    """For every row its number within its group, in random order, and how many these are.

    shows: of every row, how much of the magnitude it shows. Those that show the most have the
    largest, the least, the second largest and so on; those that show the least are between.
    """
    places = defaultdict(list)
    for row, group in enumerate(groups):
        places[group].append(row)
    found = [(0, 1)] * len(groups)
    for rows in places.values():
        order = list(random.permutation(rows))
        if shows:
            order = sorted(order, key=lambda row: -shows[row])
            order = [*order[1::2], *order[::2][::-1]]
        for rank, row in enumerate(order):
            found[row] = (rank, len(rows))
    return found


@lru_cache(64)
def _block(seed: int, number: int) -> tuple[Draw, ...]:
    random = np.random.default_rng([seed, number, BLOCK])
    pairs = covering_rows(TRAITS, BLOCK - len(STEADY_INERTIAS), random)
    places = random.permutation(BLOCK)  # the first are those of the steady ones
    rows = [dict[str, str]() for _ in range(BLOCK)]
    for place, row in zip(
        places, [*(_steady_row(random) for _ in STEADY_INERTIAS), *pairs], strict=True
    ):
        rows[place] = row
    shares = [dict[str, float]() for _ in rows]
    for name, key in SPREAD_BY.items():
        shows = list(map(SHOWN_BY[name], rows)) if name in SHOWN_BY else ()
        ranks = _ranks(list(map(key, rows)), random, shows)
        for share, (rank, of) in zip(shares, ranks, strict=True):
            share[name] = (rank + random.random()) / of
    steady = dict(zip(map(int, places), STEADY_INERTIAS, strict=False))
    for place, inertia in steady.items():
        shares[place]["inertia"] = inertia
    # those of large torques have every sign among them, and so have the others
    ranks = _ranks([_drive(row) for row in rows], random)
    octants = [OCTANTS[rank % len(OCTANTS)] for rank, _ in ranks]
    both = _in_both_frames(rows)
    return tuple(
        Draw(row, shares[place], octants[place], place in steady, place in both)
        for place, row in enumerate(rows)
    )


def _steady_row(random: Generator) -> dict[str, str]:
    """The traits of a body that spins steadily; it is never at rest."""
    levels = {**TRAITS, "rate": TRAITS["rate"][1:], **{k: (v,) for k, v in STEADY.items()}}
    return {name: str(random.choice(levels[name])) for name in TRAITS}


def _drive(traits: Mapping[str, str]) -> tuple[bool, bool]:
    """Whether a torque acts, and whether it is large."""
    large = traits["bulk"].endswith("large") and traits["rate"] != "slow"
    return traits["torque"] != "none", large


def _in_both_frames(rows: Sequence[Mapping[str, str]]) -> set[int]:
    """Of the free bodies with a torque every fourth, from the first, and so of the pivoted ones."""
    driven = [place for place, row in enumerate(rows) if row["torque"] != "none"]
    pivoted = [place for place in driven if rows[place]["support"].startswith("pivot")]
    free = [place for place in driven if place not in pivoted]
    return {*free[::FOURTH], *pivoted[::FOURTH]}


def drawn(seed: int, index: int) -> Draw:
    """The traits of the system of this number."""
    number, row = divmod(index, BLOCK)
    return _block(seed, number)[row]
