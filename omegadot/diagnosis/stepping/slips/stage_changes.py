"""What may be wrong in single stages of a step: which quantity, in which stages, and how."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache

from omegadot.diagnosis.stepping.slips.stage_sets import (
    ORDINALS,
    Sources,
    in_a_row,
    places,
    some_of,
    stages_named,
    with_factor,
)


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
WHOLE = ("turn", "move", "angular", "linear")
RATES: Mapping[str, tuple[str, ...]] = {
    "omega-dot in {}": ("angular",),
    "the acceleration in {}": ("angular", "linear"),
    "the attitude's rate in {}": ("turn",),
    "the position's rate in {}": ("move",),
    "the rate of attitude and position in {}": ("turn", "move"),
    "the slope of {}": WHOLE,
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


@lru_cache
def changes_of(stages: int) -> tuple[Change, ...]:
    """All of a method of so many stages, each pair of slots and sources once."""
    found = dict[tuple[tuple[str, ...], Sources, bool], Change]()
    for one in (*_factors(stages), *_old_rates(stages), *_old_operands(stages)):
        if any(source != 1.0 for source in one.sources):
            found.setdefault((one.slots, one.sources, one.cold), one)
    return tuple(found.values())


def _factors(stages: int) -> Iterator[Change]:
    """Missing, doubled or of the wrong sign in some stages; in all, it is a wrong equation."""
    for chosen in some_of(stages):
        where = stages_named(chosen, stages)
        left = [ORDINALS[k] for k in range(stages) if k not in chosen]
        alone = len(left) == 1
        missing = f"acts in the {left[0]} stage alone" if alone else f"does not act in {where}"
        how = {
            0.0: (missing, "is zero"),
            2.0: (f"acts twice in {where}", "is doubled"),
            -1.0: (f"has the wrong sign in {where}", "has the wrong sign"),
        }
        for factor, (of_term, of_rate) in how.items():
            sources = with_factor(chosen, factor, stages)
            for name, slots in TERMS.items():
                yield Change(slots, sources, f"{name} {of_term}")
            for name, slots in RATES.items():
                yield Change(slots, sources, f"{name.format(where)} {of_rate}")


def _old_operands(stages: int) -> Iterator[Change]:
    for chosen in in_a_row(stages):
        for place, where, sources in places(chosen, stages):
            for text, slots in OPERANDS.items():
                yield Change(slots, sources, f"{text.format(place)} in {where}")


def _old_rates(stages: int) -> Iterator[Change]:
    for chosen in in_a_row(stages):
        for place, where, sources in places(chosen, stages):
            across = any(isinstance(one, tuple) and one[0] for one in sources)
            for name, slots in RATES.items():
                if across and slots == ("move",) and len(chosen) == stages:
                    continue  # as the position of a free body that is reported a step late
                text = f"{name.format(where)} is that of {place}"
                text = _of_whole(sources, chosen) or text if slots == WHOLE else text
                yield Change(slots, sources, text)
                if across:
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
