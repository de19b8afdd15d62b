"""What may be wrong in single stages of a step: which quantity, in which stages, and how."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

ORDINALS = ("first", "second", "third", "fourth")
OWN, LAST, SAME = "its own", "the last stage", "the same stage"
# A factor on what a stage has, or the stage that it is taken from: (steps before, stage from 0 on).
Source = float | tuple[int, int]
Sources = tuple[Source, ...]


@dataclass(frozen=True)
class Change:
    """Some slots with other sources than a stage's own; text: what that is, as a cause states it.

    sources: by stage.  cold: in the run's first step, what the step before has is zero.
    """

    slots: tuple[str, ...]
    sources: Sources
    text: str
    cold: bool = False


TERMS: Mapping[str, tuple[str, ...]] = {
    "the applied torque in body axes": ("body",),
    "the applied torque in world axes": ("couple",),
    "the applied torque": ("body", "couple"),
    "the damping": ("damping",),
    "the torque of gravity": ("weight",),
    "gravity": ("weight", "linear"),
    "every load": ("body", "couple", "damping", "weight", "linear"),
    "the gyroscopic term": ("gyroscopic",),
}
WHOLE = "the slope"
SLOPES: Mapping[str, tuple[str, ...]] = {
    "omega-dot": ("angular",),
    "the acceleration": ("angular", "linear"),
    "the attitude's rate": ("turn",),
    "the position's rate": ("move",),
    "the rate of attitude and position": ("turn", "move"),
    WHOLE: ("turn", "move", "angular", "linear"),
}
OPERANDS: Mapping[str, tuple[str, ...]] = {
    "the torque of gravity is taken at the attitude of {}": ("weight at",),
    "the lever of gravity is turned into the world by the attitude of {}": ("lever at",),
    "the torque in world axes is taken at the attitude of {}": ("couple at",),
    "the torques of gravity and in world axes are taken at the attitude of {}": (
        "weight at",
        "couple at",
    ),
    "the torque in body axes is taken along the body's axes of {}": ("body at",),
    "the inverse inertia is turned into the world by the attitude of {}": ("solve at",),
    "the gyroscopic term takes the inertia in world axes of {}": ("spin at",),
    "the inertia is turned into the world by the attitude of {}": ("spin at", "solve at"),
    "the gyroscopic term takes the omega of {}": ("gyroscopic at",),
    "the damping takes the omega of {}": ("damping at",),
    "the gyroscopic term and the damping take the omega of {}": ("gyroscopic at", "damping at"),
}


def changes_of(stages: int) -> list[Change]:
    """All of a method of so many stages, each pair of slots and sources once."""
    found = dict[tuple[tuple[str, ...], Sources, bool], Change]()
    for one in (*_factors(stages), *_old_slopes(stages), *_old_operands(stages)):
        found.setdefault((one.slots, one.sources, one.cold), one)
    return list(found.values())


def _sets(stages: int) -> Iterator[tuple[str, frozenset[int]]]:
    """Sets of stages, and what they are called; the set of all is the last."""
    every = frozenset(range(stages))
    for k in range(stages):
        yield f"the {ORDINALS[k]} stage", frozenset({k})
    yield "every stage after the first", every - {0}
    yield "every stage but the last", every - {stages - 1}
    if stages > 3:
        yield "the second and third stages", frozenset({1, 2})
    yield "every stage", every


def _factors(stages: int) -> Iterator[Change]:
    """Missing, doubled or of the wrong sign in some stages."""
    for where, chosen in _sets(stages):
        if len(chosen) == stages:
            continue  # a wrong equation, which its steps show as they vanish
        left = [ORDINALS[k] for k in range(stages) if k not in chosen]
        alone = f"in the {left[0]} stage alone" if len(left) == 1 else ""
        for factor in (0.0, 2.0, -1.0):
            sources = _with(stages, dict.fromkeys(chosen, factor))
            for name, slots in TERMS.items():
                acts = f"acts {alone}" if alone else f"does not act in {where}"
                how = {0.0: acts, 2.0: f"acts twice in {where}"}
                text = how.get(factor, f"has the wrong sign in {where}")
                yield Change(slots, sources, f"{name} {text}")
            for name, slots in SLOPES.items():
                how = {0.0: "is zero", 2.0: "is doubled", -1.0: "has the wrong sign"}
                yield Change(slots, sources, f"{name} {how[factor]} in {where}")


def _places(stages: int, chosen: frozenset[int]) -> Iterator[tuple[str, dict[int, Source]]]:
    """Where some stages may take something from, and what that place is called."""
    last = stages - 1
    if stages > 1:
        yield "the step's start", {k: (0, 0) for k in chosen if k}
        alone = chosen == {0}
        at = f"the last stage of the step before{'' if alone else ', or of the stage before'}"
        known: dict[int, Source] = {k: (0, k - 1) if k else (-1, last) for k in chosen}
        yield at if 0 in chosen else "the stage before", known
        yield "the last stage of the step before", dict.fromkeys(chosen, (-1, last))
    same = "the same stage" if len(chosen) == 1 else "the same stages"
    yield f"{same} of the step before", {k: (-1, k) for k in chosen}


def _old_operands(stages: int) -> Iterator[Change]:
    for where, chosen in _sets(stages):
        for place, taken in _places(stages, chosen):
            whole = place == "the step's start" and chosen >= frozenset(range(1, stages))
            within = "every stage" if whole else where
            for text, slots in OPERANDS.items():
                sources = _with(stages, taken)
                yield Change(slots, sources, f"{text.format(place)} in {within}")


def _old_slopes(stages: int) -> Iterator[Change]:
    for where, chosen in _sets(stages):
        for place, taken in _places(stages, chosen):
            sources = _with(stages, taken)
            for name, slots in SLOPES.items():
                text = f"{name} in {where} is that of {place}"
                text = _of_whole(sources, chosen) or text if name == WHOLE else text
                yield Change(slots, sources, text)
                if any(isinstance(one, tuple) and one[0] for one in sources):
                    yield Change(slots, sources, f"{text} (zero in the run's first step)", True)


def _of_whole(sources: Sources, chosen: frozenset[int]) -> str:
    """Of one stage that is another as it is; "" of several."""
    (k, *more) = sorted(chosen)
    source = sources[k]
    if more or isinstance(source, float):
        return ""
    before, j = source
    if not before:
        return f"the {ORDINALS[k]} stage is the {ORDINALS[j]} one again"
    which = "last" if j == len(sources) - 1 and j != k else ORDINALS[j]
    return f"the {ORDINALS[k]} stage is the {which} one of the step before"


def _with(stages: int, taken: Mapping[int, Source]) -> Sources:
    return tuple(taken.get(k, 1.0) for k in range(stages))
