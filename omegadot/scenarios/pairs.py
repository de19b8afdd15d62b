"""Choices of which every two occur together: a covering array of strength two, drawn greedily.

Cohen, Dalal, Fredman and Patton, The AETG system, IEEE Transactions on Software Engineering 23
(1997) 437-444.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from itertools import combinations, product

import numpy as np
from numpy.random import Generator

CANDIDATES = 10  # for each row; more of them do not make fewer rows
ATTEMPTS = 1000
FIRST_ATTEMPT = 49  # the first whose rows are as few as the random systems need

Choices = Mapping[str, Sequence[str]]
Pair = tuple[int, int, int, int]  # column, level, a later column, level


def _pairs_of(row: Sequence[int]) -> set[Pair]:
    return {(i, row[i], j, row[j]) for i, j in combinations(range(len(row)), 2)}


def _candidate(sizes: Sequence[int], missing: Sequence[Pair], random: Generator) -> list[int]:
    """A row with one missing pair, and in every other column the level that adds the most pairs."""
    open_pairs = set(missing)
    i, a, j, b = missing[int(random.integers(len(missing)))]
    row = {i: a, j: b}
    for column in map(int, random.permutation(len(sizes))):
        if column in row:
            continue
        added = [
            sum(
                ((c, level, column, own) if c < column else (column, own, c, level)) in open_pairs
                for c, level in row.items()
            )
            for own in range(sizes[column])
        ]
        row[column] = int(np.argmax(np.add(added, random.random(len(added)))))
    return [row[column] for column in range(len(sizes))]


@cache
def _rows(sizes: tuple[int, ...], most: int) -> tuple[tuple[int, ...], ...]:
    every = {
        (i, a, j, b)
        for i, j in combinations(range(len(sizes)), 2)
        for a, b in product(range(sizes[i]), range(sizes[j]))
    }
    for attempt in range(FIRST_ATTEMPT, FIRST_ATTEMPT + ATTEMPTS):
        random, rows, missing = np.random.default_rng(attempt), list[tuple[int, ...]](), set(every)
        while missing and len(rows) < most:
            left = sorted(missing)
            drawn = [_candidate(sizes, left, random) for _ in range(CANDIDATES)]
            best = max(drawn, key=lambda row: len(_pairs_of(row) & missing))
            rows.append(tuple(best))
            missing -= _pairs_of(best)
        if not missing:
            return tuple(rows)
    raise ValueError(f"no {most} rows found in which every pair of {sizes} occurs")


def covering_rows(choices: Choices, count: int, random: Generator) -> list[dict[str, str]]:
    """`count` rows, a level for every choice, in which every pair of levels occurs.

    The levels of one array are renamed, and its rows shuffled, by `random`; rows that are left over
    are drawn. Raises ValueError where so few rows are not found to be enough.
    """
    sizes = tuple(len(levels) for levels in choices.values())
    rows = np.array(_rows(sizes, count))
    drawn = [random.integers(0, size, count - len(rows)) for size in sizes]
    rows = random.permutation(np.concatenate((rows, np.transpose(drawn))))
    renamed = [random.permutation(size)[rows[:, i]] for i, size in enumerate(sizes)]
    return [
        {name: choices[name][level] for name, level in zip(choices, row, strict=True)}
        for row in np.transpose(renamed)
    ]
