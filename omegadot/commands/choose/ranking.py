"""Candidates by cost: ranks, ties within the spread of the timing, and the Pareto front."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from omegadot.commands.choose.search import EDGE
from omegadot.commands.choose.spread import Spread

Key = TypeVar("Key", bound=Hashable)


@dataclass(frozen=True)
class Place(Generic[Key]):
    """rank: 1 for the cheapest; those that cannot be distinguished from a rank's first share it."""

    key: Key
    rank: int
    tied: bool


def dearer(one: Spread, other: Spread) -> bool:
    """Whether `one` costs more than `other`, beyond the resolution of the measurement.

    In three quarters of the rounds at least it took longer by more than EDGE: a step is known no
    better than that, so neither is its cost.
    """
    return one.over(other).quartiles[0] > EDGE


def ranked(costs: Mapping[Key, Spread]) -> list[Place[Key]]:
    """Places by median cost. Two of which neither is dearer are a tie, not a win and a loss.

    A place's ties are with its first: of three where each ties with its neighbour alone, the third
    is not dragged up to the first.
    """
    order = sorted(costs, key=lambda key: costs[key].median)
    groups: list[list[Key]] = []
    for key in order:
        if groups and not dearer(costs[key], costs[groups[-1][0]]):
            groups[-1].append(key)
        else:
            groups.append([key])
    places, rank = [], 1
    for group in groups:
        places += [Place(key, rank, len(group) > 1) for key in group]
        rank += len(group)
    return places


@dataclass(frozen=True)
class Point(Generic[Key]):
    """A run that meets the limits. figures: cost, error, memory and so on: less is better."""

    key: Key
    figures: tuple[float, ...]


def _beats(one: Point[Key], other: Point[Key]) -> bool:
    pairs = list(zip(one.figures, other.figures, strict=True))
    return all(a <= b for a, b in pairs) and any(a < b for a, b in pairs)


def front(points: Sequence[Point[Key]]) -> list[Point[Key]]:
    """The points that no other one equals or betters in everything: the Pareto front."""
    return [p for p in points if not any(_beats(other, p) for other in points)]
