"""Conditions that hold for all that fail and for none of the others, by systems that part them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations

Kind = tuple[str, bool]  # a sentence, and whether it holds
Tried = tuple[Mapping[str, bool], bool]  # what holds of a system, and whether a fault shows in it


def decided(conditions: Sequence[Kind], tried: Sequence[Tried]) -> list[tuple[Kind, ...]]:
    """Those that no tried system contradicts, each alone; else the one pair that must hold at once.

    Of conditions that all hold, or none, on every scenario a system with one of them alone decides.
    None where each is contradicted, and so is each pair, or several pairs are left.
    """

    def holds(every: tuple[Kind, ...]) -> bool:
        return all(
            all(kinds[text] is wanted for text, wanted in every) is wrong for kinds, wrong in tried
        )

    alone: list[tuple[Kind, ...]] = [(one,) for one in conditions if holds((one,))]
    pairs: list[tuple[Kind, ...]] = [two for two in combinations(conditions, 2) if holds(two)]
    return alone or (pairs if len(pairs) == 1 else [])
