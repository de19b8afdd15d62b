"""Where no cause fits: what is known of the difference, in one sentence over all that show it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import comb

from omegadot.diagnosis.equations.dependence import Powers, dependence_text, powers_of
from omegadot.diagnosis.equations.describe import Off, off_of, off_text
from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.wording.features import Features, in_common, ways_of

OF_THE_STATE = ("|omega|", "the speed", "the place")


def known_over(
    scenes: Sequence[Scene], passing: Sequence[Features], source: str, along: str
) -> str:
    """Of the scenarios on which nothing fits; a fact that one of them contradicts is left out.

    passing: of the scenarios that are right.  along: a vector that all of it is along; "" if none.
    """
    parts = [(scene, scene.evidence[source]) for scene in scenes]
    texts = list[str]()
    angular = _over([off for _, e in parts if (off := off_of(e, "angular")) is not None])
    free = [(s, e) for s, e in parts if s.system.load.pivot is None or angular is None]
    linear = _over([off for _, e in free if (off := off_of(e, "linear")) is not None])
    if angular is not None:
        texts.append(off_text("omega-dot", angular, along))
    if linear is not None:
        texts.append(off_text("the linear acceleration", linear))
    if texts and source == "forward":
        kind = "angular" if angular is not None else "linear"
        powers = _powers_over([powers_of(e, s.scaled, kind) for s, e in parts if s.scaled])
        texts.append(_goes(powers, angular or linear, [e for _, e in parts]))
    texts.append(scenarios_in_common([s.features for s in scenes], passing))
    return "; ".join(text for text in texts if text)


def _goes(powers: Powers, off: Off | None, every: Sequence[Evidence]) -> str:
    """On what it depends. What changes with the state may still change with the attitude alone."""
    free = any(e.system.load.pivot is None for e in every)
    moves = OF_THE_STATE if free else OF_THE_STATE[:1]  # a pivoted body's place is its attitude's
    alone = off is not None and off.turns and all(powers.get(what) == 0.0 for what in moves)
    rest = {k: v for k, v in powers.items() if not (alone and k in OF_THE_STATE)}
    texts = ["nothing else of the state than the attitude is seen to change it"] if alone else []
    return "; ".join(text for text in (*texts, dependence_text(rest)) if text)


def _over(every: Sequence[Off]) -> Off | None:
    """What holds wherever something is seen."""
    if not every:
        return None
    powers = {one.power for one in every if one.power is not None}
    return Off(
        frozenset().union(*(one.axes for one in every)),
        frozenset.intersection(*(one.along for one in every)),
        powers.pop() if len(powers) == 1 else None,
        max(one.share for one in every),
        all(one.turns for one in every),
    )


def _powers_over(every: Sequence[Mapping[str, float | None]]) -> Powers:
    """Exponents that no scenario contradicts; what one cannot show is left to the others."""
    found = dict[str, set[float | None]]()
    for one in every:
        for name, power in one.items():
            found.setdefault(name, set()).add(power)
    only = {name: next(iter(values)) for name, values in found.items() if len(values) == 1}
    return {name: power for name, power in only.items() if power is not None}


def scenarios_in_common(failing: Sequence[Features], passing: Sequence[Features]) -> str:
    """What the scenarios that fail have in common and the others lack."""
    if comb(len(failing) + len(passing), len(failing)) < ways_of(failing):
        return ""  # so few are sorted by chance
    common = in_common(failing, passing)
    if not common or len(common) > 2:
        return ""
    return f"it fails in scenarios alone where {' or where '.join(common)}"
