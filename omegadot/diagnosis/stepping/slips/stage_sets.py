"""Sets of the stages of a step, where they may take something from, and what these are called."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import combinations

from omegadot.diagnosis.wording.digits import listed

ORDINALS = ("first", "second", "third", "fourth")
# A factor on what a stage has, or the stage that it is taken from: (steps before, stage from 0 on).
Source = float | tuple[int, int]
Sources = tuple[Source, ...]
START, BEFORE, ACROSS = "the step's start", "the stage before", ", also from one step to the next"


def stages_named(chosen: frozenset[int], stages: int) -> str:
    """What a set of stages, numbered from 0 on, is called."""
    left = frozenset(range(stages)) - chosen
    names = [ORDINALS[k] for k in sorted(chosen)]
    if not left:
        return "every stage"
    if left == {0} and stages > 2:
        return "every stage after the first"
    if len(left) == 1 and stages > 2:
        return f"every stage but the {ORDINALS[min(left)]}"
    return f"the {listed(names)} stage{'s' * (len(names) > 1)}"


def some_of(stages: int) -> Iterator[frozenset[int]]:
    """All sets but that of all."""
    for count in range(1, stages):
        yield from map(frozenset, combinations(range(stages), count))


def in_a_row(stages: int) -> Iterator[frozenset[int]]:
    """One stage each, those after the first, those before the last, the middle ones, and all."""
    every = frozenset(range(stages))
    ends = ({0}, {stages - 1}, {0, stages - 1}, frozenset[int]())
    found = (*(frozenset({k}) for k in every), *(every - one for one in ends))
    yield from filter(None, dict.fromkeys(found))


def places(chosen: frozenset[int], stages: int) -> Iterator[tuple[str, str, Sources]]:
    """What a place is called, in which stages it is taken, and the sources that this makes."""
    last, where = stages - 1, stages_named(chosen, stages)
    within = stages_named(chosen | {0}, stages)  # at its start the first stage is
    start: dict[int, Source] = {k: (0, 0) for k in chosen if k}
    yield START, within if chosen | {0} == {*range(stages)} else where, _sources(start, stages)
    final, first = (dict[int, Source].fromkeys(chosen, (-1, k)) for k in (last, 0))
    yield "the last stage of the step before", where, _sources(final, stages)
    across = ACROSS * (0 in chosen)
    before: dict[int, Source] = {k: (0, k - 1) if k else (-1, last) for k in chosen}
    yield BEFORE, f"{where}{across}", _sources(before, stages)
    same: dict[int, Source] = {k: (-1, k) for k in chosen}
    yield (
        f"the same stage{'s' * (len(chosen) > 1)} of the step before",
        where,
        _sources(same, stages),
    )
    yield "the start of the step before", where, _sources(first, stages)


def with_factor(chosen: frozenset[int], factor: float, stages: int) -> Sources:
    """The sources of stages of which some have a factor."""
    return _sources(dict[int, Source].fromkeys(chosen, factor), stages)


def _sources(taken: Mapping[int, Source], stages: int) -> Sources:
    return tuple(taken.get(k, 1.0) for k in range(stages))
